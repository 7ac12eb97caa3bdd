// divider_2: hapticore_model::blocks::divider::Divider
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module divider_2 (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  Takes the operands and begins.
    input wire [26:0] numerator, // u27.23  What is divided.
    input wire [27:0] denominator, // u28.23  By what.
    output reg done, // u1.0  Set for one clock when the quotient is there.
    output reg [23:0] quotient, // u24.22  The quotient, held until the next is there.
    output reg saturated // u1.0  Whether the quotient is held at its rail.
);

    reg busy; // u1.0
    reg [4:0] count; // u5.0
    reg [27:0] denominator_q; // u28.23
    reg [27:0] remainder; // u28.0
    reg [23:0] tail; // u24.0
    reg [23:0] partial; // u24.0
    reg over; // u1.0

    wire count_is_24 = count == 5'd24; // u1.0
    wire [48:0] fit_19 = {numerator, 22'd0}; // u49.45
    wire bit_23 = ~({3'd0, fit_19[48:24]} < denominator); // u1.0
    wire bit_34 = ({1'd0, denominator_q} < {remainder, 1'd0}) | (({remainder, 1'd0} == {1'd0, denominator_q}) & partial[0]); // u1.0
    wire [25:0] fit_36 = {1'd0, {1'd0, partial} + {24'd0, bit_34}}; // u26.0
    wire [23:0] fit_37 = (|fit_36[25:24]) ? {24{1'b1}} : fit_36[23:0]; // u24.0
    wire [28:0] joined_45 = {remainder, tail[23]}; // u29.0
    wire bit_47 = ~(joined_45 < {1'd0, denominator_q}); // u1.0
    wire [5:0] sum_50 = {1'd0, count} + 6'd1; // u6.0
    wire signed [29:0] choice_49 = bit_47 ? ({1'd0, joined_45} - {2'd0, denominator_q}) : {1'd0, joined_45}; // s30.0
    wire [24:0] joined_53 = {tail, 1'd0}; // u25.0
    wire [24:0] joined_55 = {partial, bit_47}; // u25.0

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            count <= 5'd0;
            denominator_q <= 28'd0;
            remainder <= 28'd0;
            tail <= 24'd0;
            partial <= 24'd0;
            over <= 1'd0;
            done <= 1'd0;
            quotient <= 24'd0;
            saturated <= 1'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                count <= 5'd0;
                denominator_q <= denominator;
                partial <= 24'd0;
                over <= bit_23;
                done <= 1'd0;
                if (bit_23) begin
                    remainder <= 28'd0;
                    tail <= 24'd0;
                end else begin
                    remainder <= {3'd0, fit_19[48:24]};
                    tail <= fit_19[23:0];
                end
            end else if (busy) begin
                if (count_is_24) begin
                    busy <= 1'd0;
                    done <= 1'd1;
                    quotient <= over ? 24'd16777215 : fit_37;
                    saturated <= (~({2'd0, fit_37} == fit_36)) | over;
                end else begin
                    count <= sum_50[4:0];
                    remainder <= choice_49[27:0];
                    tail <= joined_53[23:0];
                    partial <= joined_55[23:0];
                    done <= 1'd0;
                end
            end else begin
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_50[5], choice_49[29:28], joined_53[24], joined_55[24]};

endmodule

`default_nettype wire

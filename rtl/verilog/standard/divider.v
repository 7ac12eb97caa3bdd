// divider: hapticore_model::blocks::divider::Divider
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module divider (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  Takes the operands and begins.
    input wire [30:0] numerator, // u31.23  What is divided.
    input wire [29:0] denominator, // u30.23  By what.
    output reg done, // u1.0  Set for one clock when the quotient is there.
    output reg [20:0] quotient, // u21.20  The quotient, held until the next is there.
    output reg saturated // u1.0  Whether the quotient is held at its rail.
);

    reg busy; // u1.0
    reg [4:0] count; // u5.0
    reg [29:0] denominator_q; // u30.23
    reg [29:0] remainder; // u30.0
    reg [20:0] tail; // u21.0
    reg [20:0] partial; // u21.0
    reg over; // u1.0

    wire count_is_21 = count == 5'd21; // u1.0
    wire [50:0] fit_19 = {numerator, 20'd0}; // u51.43
    wire bit_23 = ~(fit_19[50:21] < denominator); // u1.0
    wire bit_34 = ({1'd0, denominator_q} < {remainder, 1'd0}) | (({remainder, 1'd0} == {1'd0, denominator_q}) & partial[0]); // u1.0
    wire [22:0] fit_36 = {1'd0, {1'd0, partial} + {21'd0, bit_34}}; // u23.0
    wire [20:0] fit_37 = (|fit_36[22:21]) ? {21{1'b1}} : fit_36[20:0]; // u21.0
    wire [30:0] joined_45 = {remainder, tail[20]}; // u31.0
    wire bit_47 = ~(joined_45 < {1'd0, denominator_q}); // u1.0
    wire [5:0] sum_50 = {1'd0, count} + 6'd1; // u6.0
    wire signed [31:0] choice_49 = bit_47 ? ({1'd0, joined_45} - {2'd0, denominator_q}) : {1'd0, joined_45}; // s32.0
    wire [21:0] joined_53 = {tail, 1'd0}; // u22.0
    wire [21:0] joined_55 = {partial, bit_47}; // u22.0

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            count <= 5'd0;
            denominator_q <= 30'd0;
            remainder <= 30'd0;
            tail <= 21'd0;
            partial <= 21'd0;
            over <= 1'd0;
            done <= 1'd0;
            quotient <= 21'd0;
            saturated <= 1'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                count <= 5'd0;
                denominator_q <= denominator;
                partial <= 21'd0;
                over <= bit_23;
                done <= 1'd0;
                if (bit_23) begin
                    remainder <= 30'd0;
                    tail <= 21'd0;
                end else begin
                    remainder <= fit_19[50:21];
                    tail <= fit_19[20:0];
                end
            end else if (busy) begin
                if (count_is_21) begin
                    busy <= 1'd0;
                    done <= 1'd1;
                    quotient <= over ? 21'd2097151 : fit_37;
                    saturated <= (~({2'd0, fit_37} == fit_36)) | over;
                end else begin
                    count <= sum_50[4:0];
                    remainder <= choice_49[29:0];
                    tail <= joined_53[20:0];
                    partial <= joined_55[20:0];
                    done <= 1'd0;
                end
            end else begin
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_50[5], choice_49[31:30], joined_53[21], joined_55[21]};

endmodule

`default_nettype wire

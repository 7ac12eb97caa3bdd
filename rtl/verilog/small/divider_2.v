// divider_2: hapticore_model::blocks::divider::Divider
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module divider_2 (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  Takes the operands and begins.
    input wire [15:0] numerator, // u16.13  What is divided.
    input wire [16:0] denominator, // u17.13  By what.
    output reg done, // u1.0  Set for one clock when the quotient is there.
    output reg [14:0] quotient, // u15.14  The quotient, held until the next is there.
    output reg saturated // u1.0  Whether the quotient is held at its rail.
);

    reg busy; // u1.0
    reg [3:0] count; // u4.0
    reg [16:0] denominator_q; // u17.13
    reg [16:0] remainder; // u17.0
    reg [14:0] tail; // u15.0
    reg [14:0] partial; // u15.0
    reg over; // u1.0

    wire count_is_15 = count == 4'd15; // u1.0
    wire [29:0] fit_19 = {numerator, 14'd0}; // u30.27
    wire bit_23 = ~({2'd0, fit_19[29:15]} < denominator); // u1.0
    wire bit_34 = ({1'd0, denominator_q} < {remainder, 1'd0}) | (({remainder, 1'd0} == {1'd0, denominator_q}) & partial[0]); // u1.0
    wire [16:0] fit_36 = {1'd0, {1'd0, partial} + {15'd0, bit_34}}; // u17.0
    wire [14:0] fit_37 = (|fit_36[16:15]) ? {15{1'b1}} : fit_36[14:0]; // u15.0
    wire [17:0] joined_45 = {remainder, tail[14]}; // u18.0
    wire bit_47 = ~(joined_45 < {1'd0, denominator_q}); // u1.0
    wire [4:0] sum_50 = {1'd0, count} + 5'd1; // u5.0
    wire signed [18:0] choice_49 = bit_47 ? ({1'd0, joined_45} - {2'd0, denominator_q}) : {1'd0, joined_45}; // s19.0
    wire [15:0] joined_53 = {tail, 1'd0}; // u16.0
    wire [15:0] joined_55 = {partial, bit_47}; // u16.0

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            count <= 4'd0;
            denominator_q <= 17'd0;
            remainder <= 17'd0;
            tail <= 15'd0;
            partial <= 15'd0;
            over <= 1'd0;
            done <= 1'd0;
            quotient <= 15'd0;
            saturated <= 1'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                count <= 4'd0;
                denominator_q <= denominator;
                partial <= 15'd0;
                over <= bit_23;
                done <= 1'd0;
                if (bit_23) begin
                    remainder <= 17'd0;
                    tail <= 15'd0;
                end else begin
                    remainder <= {2'd0, fit_19[29:15]};
                    tail <= fit_19[14:0];
                end
            end else if (busy) begin
                if (count_is_15) begin
                    busy <= 1'd0;
                    done <= 1'd1;
                    quotient <= over ? 15'd32767 : fit_37;
                    saturated <= (~({2'd0, fit_37} == fit_36)) | over;
                end else begin
                    count <= sum_50[3:0];
                    remainder <= choice_49[16:0];
                    tail <= joined_53[14:0];
                    partial <= joined_55[14:0];
                    done <= 1'd0;
                end
            end else begin
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_50[4], choice_49[18:17], joined_53[15], joined_55[15]};

endmodule

`default_nettype wire

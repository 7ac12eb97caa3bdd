// divider: hapticore_model::blocks::divider::Divider
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module divider (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  Takes the operands and begins.
    input wire [19:0] numerator, // u20.13  What is divided.
    input wire [18:0] denominator, // u19.13  By what.
    output reg done, // u1.0  Set for one clock when the quotient is there.
    output reg [16:0] quotient, // u17.16  The quotient, held until the next is there.
    output reg saturated // u1.0  Whether the quotient is held at its rail.
);

    reg busy; // u1.0
    reg [4:0] count; // u5.0
    reg [18:0] denominator_q; // u19.13
    reg [18:0] remainder; // u19.0
    reg [16:0] tail; // u17.0
    reg [16:0] partial; // u17.0
    reg over; // u1.0

    wire count_is_17 = count == 5'd17; // u1.0
    wire [35:0] fit_19 = {numerator, 16'd0}; // u36.29
    wire bit_23 = ~(fit_19[35:17] < denominator); // u1.0
    wire bit_34 = ({1'd0, denominator_q} < {remainder, 1'd0}) | (({remainder, 1'd0} == {1'd0, denominator_q}) & partial[0]); // u1.0
    wire [18:0] fit_36 = {1'd0, {1'd0, partial} + {17'd0, bit_34}}; // u19.0
    wire [16:0] fit_37 = (|fit_36[18:17]) ? {17{1'b1}} : fit_36[16:0]; // u17.0
    wire [19:0] joined_45 = {remainder, tail[16]}; // u20.0
    wire bit_47 = ~(joined_45 < {1'd0, denominator_q}); // u1.0
    wire [5:0] sum_50 = {1'd0, count} + 6'd1; // u6.0
    wire signed [20:0] choice_49 = bit_47 ? ({1'd0, joined_45} - {2'd0, denominator_q}) : {1'd0, joined_45}; // s21.0
    wire [17:0] joined_53 = {tail, 1'd0}; // u18.0
    wire [17:0] joined_55 = {partial, bit_47}; // u18.0

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            count <= 5'd0;
            denominator_q <= 19'd0;
            remainder <= 19'd0;
            tail <= 17'd0;
            partial <= 17'd0;
            over <= 1'd0;
            done <= 1'd0;
            quotient <= 17'd0;
            saturated <= 1'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                count <= 5'd0;
                denominator_q <= denominator;
                partial <= 17'd0;
                over <= bit_23;
                done <= 1'd0;
                if (bit_23) begin
                    remainder <= 19'd0;
                    tail <= 17'd0;
                end else begin
                    remainder <= fit_19[35:17];
                    tail <= fit_19[16:0];
                end
            end else if (busy) begin
                if (count_is_17) begin
                    busy <= 1'd0;
                    done <= 1'd1;
                    quotient <= over ? 17'd131071 : fit_37;
                    saturated <= (~({2'd0, fit_37} == fit_36)) | over;
                end else begin
                    count <= sum_50[4:0];
                    remainder <= choice_49[18:0];
                    tail <= joined_53[16:0];
                    partial <= joined_55[16:0];
                    done <= 1'd0;
                end
            end else begin
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_50[5], choice_49[20:19], joined_53[17], joined_55[17]};

endmodule

`default_nettype wire

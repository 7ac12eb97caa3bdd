// ratio: hapticore_model::blocks::ratio::Ratio
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module ratio (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  The sums are there, and hold.
    input wire signed [20:0] x, // s21.15  The numerator of r_x.
    input wire signed [20:0] y, // s21.15  The numerator of r_y.
    input wire [19:0] corners, // u20.15  Their denominator.
    output reg done, // u1.0  Set for one clock when the ratios are there.
    output reg signed [15:0] r_x, // s16.14  The x ratio.
    output reg signed [15:0] r_y, // s16.14  The y ratio.
    output reg invalid // u1.0  Whether the denominator is zero.
);

    reg [1:0] step; // u2.0  0 idle, 1 x, 2 y
    reg divide; // u1.0
    wire divider_done; // u1.0
    wire [14:0] divider_quotient; // u15.14
    wire divider_saturated; // u1.0

    wire step_is_x = step == 2'd1; // u1.0
    wire signed [20:0] numerator = step_is_x ? x : y; // s21.15
    wire bit_22 = divider_done & step_is_x; // u1.0
    wire bit_25 = divider_done & (step == 2'd2); // u1.0

    divider u_divider (
        .clock(clock),
        .reset(reset),
        .start(divide),
        .numerator(numerator[20] ? 21'd0 - numerator : numerator),
        .denominator(corners),
        .done(divider_done),
        .quotient(divider_quotient),
        .saturated(divider_saturated)
    );

    always @(posedge clock) begin
        if (reset) begin
            step <= 2'd0;
            divide <= 1'd0;
            r_x <= 16'd0;
            r_y <= 16'd0;
            invalid <= 1'd0;
            done <= 1'd0;
        end else begin
            if (start) begin
                step <= 2'd1;
                divide <= 1'd1;
                done <= 1'd0;
            end else begin
                step <= bit_22 ? 2'd2 : bit_25 ? 2'd0 : step;
                divide <= bit_22;
                done <= bit_25;
                if (divider_done) begin
                    r_y <=
                        (numerator < $signed(21'd0)) ? (16'd0 - {1'd0, divider_quotient})
                        : {1'd0, divider_quotient};
                end
                if (bit_25) begin
                    r_x <= r_y;
                    invalid <= corners == 20'd0;
                end
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, divider_saturated};

endmodule

`default_nettype wire

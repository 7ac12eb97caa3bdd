// ratio: hapticore_model::blocks::ratio::Ratio
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module ratio (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  The sums are there, and hold.
    input wire signed [30:0] x, // s31.23  The numerator of r_x.
    input wire signed [30:0] y, // s31.23  The numerator of r_y.
    input wire [29:0] corners, // u30.23  Their denominator.
    input wire [26:0] least, // u27.23  The least amplitude of the terminals.
    output reg done, // u1.0  Set for one clock when the ratios are there.
    output reg signed [21:0] r_x, // s22.20  The x ratio.
    output reg signed [21:0] r_y, // s22.20  The y ratio.
    output wire [20:0] share, // u21.20  The least of the terminals' currents, as a share of the denominator; until the next slot's `start`.
    output reg invalid // u1.0  Whether the denominator is zero.
);

    reg [1:0] step; // u2.0  0 idle, 1 x, 2 y, 3 share
    reg divide; // u1.0
    wire divider_done; // u1.0
    wire [20:0] divider_quotient; // u21.20
    wire divider_saturated; // u1.0

    wire step_is_x = step == 2'd1; // u1.0
    wire signed [30:0] numerator = step_is_x ? x : y; // s31.23
    wire step_is_share = step == 2'd3; // u1.0
    wire bit_27 = divider_done & step_is_x; // u1.0
    wire bit_30 = divider_done & (step == 2'd2); // u1.0
    wire bit_31 = divider_done & step_is_share; // u1.0
    wire bit_39 = bit_27 | bit_30; // u1.0

    divider u_divider (
        .clock(clock),
        .reset(reset),
        .start(divide),
        .numerator(step_is_share ? {4'd0, least} : numerator[30] ? 31'd0 - numerator : numerator),
        .denominator(corners),
        .done(divider_done),
        .quotient(divider_quotient),
        .saturated(divider_saturated)
    );

    always @(posedge clock) begin
        if (reset) begin
            step <= 2'd0;
            divide <= 1'd0;
            r_x <= 22'd0;
            r_y <= 22'd0;
            invalid <= 1'd0;
            done <= 1'd0;
        end else begin
            if (start) begin
                step <= 2'd1;
                divide <= 1'd1;
                done <= 1'd0;
            end else begin
                step <= bit_27 ? 2'd2 : bit_30 ? 2'd3 : bit_31 ? 2'd0 : step;
                divide <= bit_39;
                done <= bit_31;
                if (bit_39) begin
                    r_y <=
                        (numerator < $signed(31'd0)) ? (22'd0 - {1'd0, divider_quotient})
                        : {1'd0, divider_quotient};
                end
                if (bit_30) begin
                    r_x <= r_y;
                    invalid <= corners == 30'd0;
                end
            end
        end
    end

    assign share = divider_quotient;

    // What nothing needs.
    wire unused = &{1'b0, divider_saturated};

endmodule

`default_nettype wire

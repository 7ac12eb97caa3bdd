// pace: hapticore_model::blocks::pace::Pace
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module pace (
    input wire clock,
    input wire reset,
    input wire strobe, // u1.0  A set of ADC codes is there.
    input wire clear, // u1.0  Forgets.
    output reg overrun // u1.0  A strobe was too early.
);

    reg [4:0] left; // u5.0

    wire left_is_0 = left == 5'd0; // u1.0
    wire signed [5:0] difference_10 = {1'd0, left} - 6'd1; // s6.0
    wire bit_13 = ~clear; // u1.0

    always @(posedge clock) begin
        if (reset) begin
            left <= 5'd0;
            overrun <= 1'd0;
        end else begin
            left <= (strobe & bit_13) ? 5'd24 : left_is_0 ? 5'd0 : difference_10[4:0];
            overrun <= (overrun | (strobe & (~left_is_0))) & bit_13;
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, difference_10[5]};

endmodule

`default_nettype wire

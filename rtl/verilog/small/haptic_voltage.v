// haptic_voltage: hapticore_model::blocks::haptic_voltage::HapticVoltage
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module haptic_voltage (
    input wire clock,
    input wire reset,
    input wire clear, // u1.0  Windows of before count no more.
    input wire [1:0] pad, // u2.0  The pad of the window; stable until the next window's sums.
    input wire valid, // u1.0  Asserted for one cycle with each sum.
    input wire [3:0] index, // u4.0  The number of the sum; the last is that of the squares.
    input wire signed [41:0] sum, // s42.31  The sum.
    output reg [14:0] mean_square, // u15.15  The mean square.
    output reg saturated // u1.0  A window's mean square is saturated.
);

    wire squares_valid = valid & (index == 4'd14); // u1.0
    wire signed [18:0] fit_19 = {sum[41], sum[41:24]} + {18'd0, sum[23] & (sum[24] | (|sum[22:0]))}; // s19.15

    always @(posedge clock) begin
        if (reset) begin
            mean_square <= 15'd0;
            saturated <= 1'd0;
        end else begin
            if (squares_valid) begin
                mean_square <= fit_19[18] ? 15'd0 : (|fit_19[17:15]) ? {15{1'b1}} : fit_19[14:0];
                saturated <= ~(fit_19[18:15] == 4'd0);
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, clear, pad};

endmodule

`default_nettype wire

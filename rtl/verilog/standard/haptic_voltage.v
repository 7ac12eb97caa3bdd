// haptic_voltage: hapticore_model::blocks::haptic_voltage::HapticVoltage
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module haptic_voltage (
    input wire clock,
    input wire reset,
    input wire clear, // u1.0  Windows of before count no more.
    input wire [1:0] pad, // u2.0  The pad of the window; stable until the next window's sums.
    input wire valid, // u1.0  Asserted for one cycle with each sum.
    input wire [3:0] index, // u4.0  The number of the sum; the last is that of the squares.
    input wire signed [44:0] sum, // s45.34  The sum.
    output reg [21:0] mean_square, // u22.22  The mean square.
    output reg saturated // u1.0  A window's mean square is saturated.
);

    wire squares_valid = valid & (index == 4'd14); // u1.0
    wire signed [24:0] fit_19 = {sum[44], sum[44:21]} + {24'd0, sum[20] & (sum[21] | (|sum[19:0]))}; // s25.22

    always @(posedge clock) begin
        if (reset) begin
            mean_square <= 22'd0;
            saturated <= 1'd0;
        end else begin
            if (squares_valid) begin
                mean_square <= fit_19[24] ? 22'd0 : (|fit_19[23:22]) ? {22{1'b1}} : fit_19[21:0];
                saturated <= ~(fit_19[24:22] == 3'd0);
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, clear, pad};

endmodule

`default_nettype wire

// multiplier_3: hapticore_model::blocks::multiplier::Multiplier
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module multiplier_3 (
    input wire clock,
    input wire reset,
    input wire enable, // u1.0  Set while somebody waits for a product.
    input wire signed [18:0] left, // s19.0  A code as an integer.
    input wire [14:0] right, // u15.0  A code as an integer.
    output reg signed [33:0] product // s34.0  The product.
);

    reg signed [24:0] high_high; // s25.-9
    reg [23:0] low_high; // u24.0

    wire signed [34:0] sum_8 = {{1{high_high[24]}}, high_high, 9'd0} + {11'd0, low_high}; // s35.0
    wire signed [9:0] fit_10 = left[18:9]; // s10.-9
    wire signed [24:0] product_13 = fit_10 * $signed({1'b0, right}); // s25.-9
    wire [8:0] bits_11 = left[8:0]; // u9.0
    wire [23:0] product_14 = bits_11 * right; // u24.0

    always @(posedge clock) begin
        if (enable) begin
            high_high <= product_13;
            low_high <= product_14;
            product <= sum_8[33:0];
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_8[34], reset};

endmodule

`default_nettype wire

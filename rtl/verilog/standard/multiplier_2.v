// multiplier_2: hapticore_model::blocks::multiplier::Multiplier
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module multiplier_2 (
    input wire clock,
    input wire reset,
    input wire enable, // u1.0  Set while somebody waits for a product.
    input wire signed [25:0] left, // s26.0  A code as an integer.
    input wire signed [25:0] right, // s26.0  A code as an integer.
    output reg signed [51:0] product // s52.0  The product.
);

    reg signed [25:0] high_high; // s26.-26
    reg signed [25:0] high_low; // s26.-13
    reg signed [25:0] low_high; // s26.-13
    reg [25:0] low_low; // u26.0

    wire signed [52:0] sum_8 = {{1{high_high[25]}}, high_high, 26'd0} + {27'd0, low_low}; // s53.0
    wire signed [51:0] fit_9 = sum_8[51:0]; // s52.0
    wire signed [26:0] sum_10 = {{1{high_low[25]}}, high_low} + {{1{low_high[25]}}, low_high}; // s27.-13
    wire signed [52:0] sum_11 = {{1{fit_9[51]}}, fit_9} + {{13{sum_10[26]}}, sum_10, 13'd0}; // s53.0
    wire signed [12:0] fit_13 = left[25:13]; // s13.-13
    wire signed [12:0] fit_16 = right[25:13]; // s13.-13
    wire signed [25:0] product_18 = fit_13 * fit_16; // s26.-26
    wire [12:0] bits_17 = right[12:0]; // u13.0
    wire signed [25:0] product_19 = fit_13 * $signed({1'b0, bits_17}); // s26.-13
    wire [12:0] bits_14 = left[12:0]; // u13.0
    wire signed [25:0] product_20 = $signed({1'b0, bits_14}) * fit_16; // s26.-13
    wire [25:0] product_21 = bits_14 * bits_17; // u26.0

    always @(posedge clock) begin
        if (enable) begin
            high_high <= product_18;
            high_low <= product_19;
            low_high <= product_20;
            low_low <= product_21;
            product <= sum_11[51:0];
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_8[52], sum_11[52], reset};

endmodule

`default_nettype wire

// multiplier_3: hapticore_model::blocks::multiplier::Multiplier
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module multiplier_3 (
    input wire clock,
    input wire reset,
    input wire enable, // u1.0  Set while somebody waits for a product.
    input wire signed [22:0] left, // s23.0  A code as an integer.
    input wire [17:0] right, // u18.0  A code as an integer.
    output reg signed [40:0] product // s41.0  The product.
);

    reg signed [20:0] high_high; // s21.-20
    reg signed [20:0] high_low; // s21.-11
    reg [19:0] low_high; // u20.-9
    reg [19:0] low_low; // u20.0

    wire signed [41:0] sum_8 = {{1{high_high[20]}}, high_high, 20'd0} + {22'd0, low_low}; // s42.0
    wire signed [40:0] fit_9 = sum_8[40:0]; // s41.0
    wire signed [23:0] sum_10 = {{1{high_low[20]}}, high_low, 2'd0} + {4'd0, low_high}; // s24.-9
    wire signed [41:0] sum_11 = {{1{fit_9[40]}}, fit_9} + {{9{sum_10[23]}}, sum_10, 9'd0}; // s42.0
    wire signed [11:0] fit_13 = left[22:11]; // s12.-11
    wire [8:0] fit_16 = right[17:9]; // u9.-9
    wire signed [20:0] product_19 = fit_13 * $signed({1'b0, fit_16}); // s21.-20
    wire [8:0] bits_17 = right[8:0]; // u9.0
    wire signed [20:0] product_20 = fit_13 * $signed({1'b0, bits_17}); // s21.-11
    wire [10:0] bits_14 = left[10:0]; // u11.0
    wire [19:0] product_21 = bits_14 * fit_16; // u20.-9
    wire [19:0] product_22 = bits_14 * bits_17; // u20.0

    always @(posedge clock) begin
        if (enable) begin
            high_high <= product_19;
            high_low <= product_20;
            low_high <= product_21;
            low_low <= product_22;
            product <= sum_11[40:0];
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_8[41], sum_11[41], reset};

endmodule

`default_nettype wire

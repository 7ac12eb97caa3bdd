// multiplier_4: hapticore_model::blocks::multiplier::Multiplier
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module multiplier_4 (
    input wire clock,
    input wire reset,
    input wire enable, // u1.0  Set while somebody waits for a product.
    input wire [23:0] left, // u24.0  A code as an integer.
    input wire [23:0] right, // u24.0  A code as an integer.
    output reg [47:0] product // u48.0  The product.
);

    reg [23:0] high_high; // u24.-24
    reg [23:0] high_low; // u24.-12
    reg [23:0] low_high; // u24.-12
    reg [23:0] low_low; // u24.0

    wire [48:0] sum_8 = {1'd0, high_high, 24'd0} + {25'd0, low_low}; // u49.0
    wire [48:0] sum_11 = {1'd0, sum_8[47:0]} + {12'd0, {1'd0, high_low} + {1'd0, low_high}, 12'd0}; // u49.0
    wire [11:0] fit_13 = left[23:12]; // u12.-12
    wire [11:0] fit_16 = right[23:12]; // u12.-12
    wire [23:0] product_18 = fit_13 * fit_16; // u24.-24
    wire [11:0] bits_17 = right[11:0]; // u12.0
    wire [23:0] product_19 = fit_13 * bits_17; // u24.-12
    wire [11:0] bits_14 = left[11:0]; // u12.0
    wire [23:0] product_20 = bits_14 * fit_16; // u24.-12
    wire [23:0] product_21 = bits_14 * bits_17; // u24.0

    always @(posedge clock) begin
        if (enable) begin
            high_high <= product_18;
            high_low <= product_19;
            low_high <= product_20;
            low_low <= product_21;
            product <= sum_11[47:0];
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_8[48], sum_11[48], reset};

endmodule

`default_nettype wire

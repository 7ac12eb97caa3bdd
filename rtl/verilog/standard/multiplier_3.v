// multiplier_3: hapticore_model::blocks::multiplier::Multiplier
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module multiplier_3 (
    input wire clock,
    input wire reset,
    input wire enable, // u1.0  Set while somebody waits for a product.
    input wire [26:0] left, // u27.0  A code as an integer.
    input wire [26:0] right, // u27.0  A code as an integer.
    output reg [53:0] product // u54.0  The product.
);

    reg [27:0] high_high; // u28.-26
    reg [26:0] high_low; // u27.-13
    reg [26:0] low_high; // u27.-13
    reg [25:0] low_low; // u26.0

    wire [54:0] sum_8 = {1'd0, high_high, 26'd0} + {29'd0, low_low}; // u55.0
    wire [54:0] sum_11 = {1'd0, sum_8[53:0]} + {14'd0, {1'd0, high_low} + {1'd0, low_high}, 13'd0}; // u55.0
    wire [13:0] fit_13 = left[26:13]; // u14.-13
    wire [13:0] fit_16 = right[26:13]; // u14.-13
    wire [27:0] product_18 = fit_13 * fit_16; // u28.-26
    wire [12:0] bits_17 = right[12:0]; // u13.0
    wire [26:0] product_19 = fit_13 * bits_17; // u27.-13
    wire [12:0] bits_14 = left[12:0]; // u13.0
    wire [26:0] product_20 = bits_14 * fit_16; // u27.-13
    wire [25:0] product_21 = bits_14 * bits_17; // u26.0

    always @(posedge clock) begin
        if (enable) begin
            high_high <= product_18;
            high_low <= product_19;
            low_high <= product_20;
            low_low <= product_21;
            product <= sum_11[53:0];
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_8[54], sum_11[54], reset};

endmodule

`default_nettype wire

// multiplier_3: hapticore_model::blocks::multiplier::Multiplier
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module multiplier_3 (
    input wire clock,
    input wire reset,
    input wire enable, // u1.0  Set while somebody waits for a product.
    input wire [14:0] left, // u15.0  A code as an integer.
    input wire [14:0] right, // u15.0  A code as an integer.
    output reg [29:0] product // u30.0  The product.
);

    wire [29:0] product_8 = left * right; // u30.0

    always @(posedge clock) begin
        if (enable) begin
            product <= product_8;
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, reset};

endmodule

`default_nettype wire

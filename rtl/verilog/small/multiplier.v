// multiplier: hapticore_model::blocks::multiplier::Multiplier
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module multiplier (
    input wire clock,
    input wire reset,
    input wire enable, // u1.0  Set while somebody waits for a product.
    input wire [15:0] left, // u16.0  A code as an integer.
    input wire [15:0] right, // u16.0  A code as an integer.
    output reg [31:0] product // u32.0  The product.
);

    wire [31:0] product_8 = left * right; // u32.0

    always @(posedge clock) begin
        if (enable) begin
            product <= product_8;
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, reset};

endmodule

`default_nettype wire

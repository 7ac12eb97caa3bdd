// multiplier_2: hapticore_model::blocks::multiplier::Multiplier
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module multiplier_2 (
    input wire clock,
    input wire reset,
    input wire enable, // u1.0  Set while somebody waits for a product.
    input wire signed [15:0] left, // s16.0  A code as an integer.
    input wire signed [15:0] right, // s16.0  A code as an integer.
    output reg signed [31:0] product // s32.0  The product.
);

    wire signed [31:0] product_8 = left * right; // s32.0

    always @(posedge clock) begin
        if (enable) begin
            product <= product_8;
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, reset};

endmodule

`default_nettype wire

// root: hapticore_model::blocks::root::Root
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module root (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  Takes the radicand and begins.
    input wire [31:0] radicand, // u32.30  The number whose root is taken.
    output reg done, // u1.0  Set for one clock when the root is there.
    output reg [16:0] root // u17.15  The root, held until the next is there.
);

    reg busy; // u1.0
    reg [4:0] count; // u5.0
    reg [31:0] tail; // u32.0
    reg [16:0] remainder; // u17.0
    reg [15:0] partial; // u16.0

    wire count_is_16 = count == 5'd16; // u1.0
    wire [18:0] shifted = {remainder, tail[31:30]}; // u19.0
    wire signed [19:0] rest = {1'd0, shifted} - {2'd0, {{partial, 1'd0}, 1'd1}}; // s20.0
    wire fits = ~rest[19]; // u1.0
    wire [5:0] sum_23 = {1'd0, count} + 6'd1; // u6.0
    wire [33:0] joined_26 = {{tail, 1'd0}, 1'd0}; // u34.0
    wire signed [19:0] choice_28 = fits ? rest : {1'd0, shifted}; // s20.0
    wire [16:0] joined_30 = {partial, fits}; // u17.0

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            count <= 5'd0;
            tail <= 32'd0;
            remainder <= 17'd0;
            partial <= 16'd0;
            done <= 1'd0;
            root <= 17'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                count <= 5'd0;
                tail <= radicand;
                remainder <= 17'd0;
                partial <= 16'd0;
                done <= 1'd0;
            end else if (busy) begin
                if (count_is_16) begin
                    busy <= 1'd0;
                    done <= 1'd1;
                    root <= {1'd0, partial} + {16'd0, {1'd0, partial} < remainder};
                end else begin
                    count <= sum_23[4:0];
                    tail <= joined_26[31:0];
                    remainder <= choice_28[16:0];
                    partial <= joined_30[15:0];
                    done <= 1'd0;
                end
            end else begin
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_23[5], joined_26[33:32], choice_28[19:17], joined_30[16]};

endmodule

`default_nettype wire

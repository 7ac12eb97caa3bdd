// root: hapticore_model::blocks::root::Root
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module root (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  Takes the radicand and begins.
    input wire [51:0] radicand, // u52.46  The number whose root is taken.
    output reg done, // u1.0  Set for one clock when the root is there.
    output reg [26:0] root // u27.23  The root, held until the next is there.
);

    reg busy; // u1.0
    reg [4:0] count; // u5.0
    reg [51:0] tail; // u52.0
    reg [26:0] remainder; // u27.0
    reg [25:0] partial; // u26.0

    wire count_is_26 = count == 5'd26; // u1.0
    wire [28:0] shifted = {remainder, tail[51:50]}; // u29.0
    wire signed [29:0] rest = {1'd0, shifted} - {2'd0, {{partial, 1'd0}, 1'd1}}; // s30.0
    wire fits = ~rest[29]; // u1.0
    wire [5:0] sum_23 = {1'd0, count} + 6'd1; // u6.0
    wire [53:0] joined_26 = {{tail, 1'd0}, 1'd0}; // u54.0
    wire signed [29:0] choice_28 = fits ? rest : {1'd0, shifted}; // s30.0
    wire [26:0] joined_30 = {partial, fits}; // u27.0

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            count <= 5'd0;
            tail <= 52'd0;
            remainder <= 27'd0;
            partial <= 26'd0;
            done <= 1'd0;
            root <= 27'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                count <= 5'd0;
                tail <= radicand;
                remainder <= 27'd0;
                partial <= 26'd0;
                done <= 1'd0;
            end else if (busy) begin
                if (count_is_26) begin
                    busy <= 1'd0;
                    done <= 1'd1;
                    root <= {1'd0, partial} + {26'd0, {1'd0, partial} < remainder};
                end else begin
                    count <= sum_23[4:0];
                    tail <= joined_26[51:0];
                    remainder <= choice_28[26:0];
                    partial <= joined_30[25:0];
                    done <= 1'd0;
                end
            end else begin
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_23[5], joined_26[53:52], choice_28[29:27], joined_30[26]};

endmodule

`default_nettype wire

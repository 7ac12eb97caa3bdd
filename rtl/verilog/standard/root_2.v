// root_2: hapticore_model::blocks::root::Root
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module root_2 (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  Takes the radicand and begins.
    input wire [53:0] radicand, // u54.46  The number whose root is taken.
    output reg done, // u1.0  Set for one clock when the root is there.
    output reg [27:0] root // u28.23  The root, held until the next is there.
);

    reg busy; // u1.0
    reg [4:0] count; // u5.0
    reg [53:0] tail; // u54.0
    reg [27:0] remainder; // u28.0
    reg [26:0] partial; // u27.0

    wire count_is_27 = count == 5'd27; // u1.0
    wire [29:0] shifted = {remainder, tail[53:52]}; // u30.0
    wire signed [30:0] rest = {1'd0, shifted} - {2'd0, {{partial, 1'd0}, 1'd1}}; // s31.0
    wire fits = ~rest[30]; // u1.0
    wire [5:0] sum_23 = {1'd0, count} + 6'd1; // u6.0
    wire [55:0] joined_26 = {{tail, 1'd0}, 1'd0}; // u56.0
    wire signed [30:0] choice_28 = fits ? rest : {1'd0, shifted}; // s31.0
    wire [27:0] joined_30 = {partial, fits}; // u28.0

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            count <= 5'd0;
            tail <= 54'd0;
            remainder <= 28'd0;
            partial <= 27'd0;
            done <= 1'd0;
            root <= 28'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                count <= 5'd0;
                tail <= radicand;
                remainder <= 28'd0;
                partial <= 27'd0;
                done <= 1'd0;
            end else if (busy) begin
                if (count_is_27) begin
                    busy <= 1'd0;
                    done <= 1'd1;
                    root <= {1'd0, partial} + {27'd0, {1'd0, partial} < remainder};
                end else begin
                    count <= sum_23[4:0];
                    tail <= joined_26[53:0];
                    remainder <= choice_28[27:0];
                    partial <= joined_30[26:0];
                    done <= 1'd0;
                end
            end else begin
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_23[5], joined_26[55:54], choice_28[30:28], joined_30[27]};

endmodule

`default_nettype wire

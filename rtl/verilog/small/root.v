// root: hapticore_model::blocks::root::Root
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module root (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  Takes the radicand and begins.
    input wire [29:0] radicand, // u30.26  The number whose root is taken.
    output reg done, // u1.0  Set for one clock when the root is there.
    output reg [15:0] root // u16.13  The root, held until the next is there.
);

    reg busy; // u1.0
    reg [3:0] count; // u4.0
    reg [29:0] tail; // u30.0
    reg [15:0] remainder; // u16.0
    reg [14:0] partial; // u15.0

    wire count_is_15 = count == 4'd15; // u1.0
    wire [17:0] shifted = {remainder, tail[29:28]}; // u18.0
    wire signed [18:0] rest = {1'd0, shifted} - {2'd0, {{partial, 1'd0}, 1'd1}}; // s19.0
    wire fits = ~rest[18]; // u1.0
    wire [4:0] sum_23 = {1'd0, count} + 5'd1; // u5.0
    wire [31:0] joined_26 = {{tail, 1'd0}, 1'd0}; // u32.0
    wire signed [18:0] choice_28 = fits ? rest : {1'd0, shifted}; // s19.0
    wire [15:0] joined_30 = {partial, fits}; // u16.0

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            count <= 4'd0;
            tail <= 30'd0;
            remainder <= 16'd0;
            partial <= 15'd0;
            done <= 1'd0;
            root <= 16'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                count <= 4'd0;
                tail <= radicand;
                remainder <= 16'd0;
                partial <= 15'd0;
                done <= 1'd0;
            end else if (busy) begin
                if (count_is_15) begin
                    busy <= 1'd0;
                    done <= 1'd1;
                    root <= {1'd0, partial} + {15'd0, {1'd0, partial} < remainder};
                end else begin
                    count <= sum_23[3:0];
                    tail <= joined_26[29:0];
                    remainder <= choice_28[15:0];
                    partial <= joined_30[14:0];
                    done <= 1'd0;
                end
            end else begin
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_23[4], joined_26[31:30], choice_28[18:16], joined_30[15]};

endmodule

`default_nettype wire

// frames: hapticore_model::blocks::frames::Frames
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module frames (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  All others are there, and hold.
    input wire [1:0] pad, // u2.0  The pad.
    input wire invalid, // u1.0  The results are invalid: those held go out.
    input wire signed [15:0] r_x, // s16.14  As [`Field::RatioX`].
    input wire signed [15:0] r_y, // s16.14  As [`Field::RatioY`].
    input wire signed [15:0] x, // s16.5  As [`Field::X`].
    input wire signed [15:0] y, // s16.5  As [`Field::Y`].
    input wire [14:0] sheet, // u15.15  As [`Field::Sheet`].
    input wire [14:0] capacitance, // u15.5  As [`Field::Capacitance`].
    input wire [14:0] haptic_force, // u15.12  As [`Field::Force`].
    input wire [14:0] mean_square, // u15.15  As [`Field::MeanSquare`].
    output reg valid, // u1.0  Set for a clock for each word.
    output reg [2:0] index, // u3.0  Which field the word is.
    output reg signed [15:0] word, // s16.0  The word.
    output reg done // u1.0  Set with the last word.
);

    reg busy; // u1.0
    reg [3:0] count; // u4.0
    (* no_rw_check *) // nobody uses a word that was read while it was being written
    reg signed [15:0] held [0:31]; // 32 words s16.0
    reg signed [15:0] held_word; // its read register

    wire signed [4:0] difference_20 = {1'd0, count} - 5'd1; // s5.0
    wire emits = busy & (~(count == 4'd0)); // u1.0
    wire [2:0] bits_21 = difference_20[2:0]; // u3.0
    wire count_is_8 = count == 4'd8; // u1.0
    wire [4:0] choice_63 = busy ? ({1'd0, count} + 5'd1) : {1'd0, count}; // u5.0

    initial begin : initial_held
        integer i;
        for (i = 0; i < 32; i = i + 1) held[i] = 16'd0;
    end

    always @(posedge clock) begin
        if (valid) held[{pad, index}] <= word;
        held_word <= held[{pad, count[2:0]}];
    end

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            count <= 4'd0;
            index <= 3'd0;
            valid <= 1'd0;
            word <= 16'd0;
            done <= 1'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                count <= 4'd0;
                valid <= 1'd0;
                done <= 1'd0;
            end else begin
                busy <= busy & (~count_is_8);
                count <= choice_63[3:0];
                valid <= emits;
                done <= emits & count_is_8;
                if (emits) begin
                    index <= bits_21;
                    word <=
                        (invalid & (~(difference_20[2:0] == 3'd7))) ? held_word
                        : bits_21[2] ? (bits_21[1] ? (bits_21[0] ? {1'd0, mean_square}
                        : {1'd0, haptic_force})
                        : bits_21[0] ? {1'd0, capacitance}
                        : {1'd0, sheet})
                        : bits_21[1] ? (bits_21[0] ? y
                        : x)
                        : bits_21[0] ? r_y
                        : r_x;
                end
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, difference_20[4:3], choice_63[4]};

endmodule

`default_nettype wire

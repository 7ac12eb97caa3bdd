// currents: hapticore_model::blocks::currents::Currents
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module currents (
    input wire clock,
    input wire reset,
    input wire valid, // u1.0  A sum is there.
    input wire [3:0] index, // u4.0  Which.
    input wire signed [41:0] sum, // s42.31  The sum.
    output reg done, // u1.0  Set for one clock when all others are there.
    output wire [15:0] total, // u16.13  The amplitude of the total current.
    output wire [15:0] sense, // u16.13  The amplitude of the sensing voltage.
    output reg signed [20:0] x, // s21.15  The numerator of r_x.
    output reg signed [20:0] y, // s21.15  The numerator of r_y.
    output reg [19:0] corners, // u20.15  Their denominator.
    output reg [16:0] least, // u17.15  The least amplitude of the terminals, in the unit of the numerators.
    output wire saturated // u1.0  Whether a word is held at a rail.
);

    reg [3:0] step; // u4.0  0 idle, 1 read, 2 in_phase, 3 read_quadrature, 4 quadrature, 5 square, 6 power, 7 root, 8 align_read, 9 align_load, 10 align_move, 11 align_keep, 12 restore
    reg arrived; // u1.0
    reg [3:0] place; // u4.0
    reg signed [27:0] word; // s28.27
    reg [2:0] channel; // u3.0
    reg signed [18:0] total_i; // s19.15
    reg signed [18:0] total_q; // s19.15
    reg signed [15:0] part; // s16.15
    reg [31:0] power; // u32.30
    reg root_start; // u1.0
    reg [16:0] sense_q; // u17.15
    reg saturated_q; // u1.0
    reg signed [27:0] long; // s28.27
    reg [3:0] count; // u4.0
    reg [3:0] limit; // u4.0
    reg [3:0] other; // u4.0
    reg quadrature; // u1.0
    reg aligning; // u1.0
    reg [19:0] whole; // u20.15
    (* no_rw_check *) // nobody uses a word that was read while it was being written
    reg signed [27:0] words [0:15]; // 16 words s28.27
    reg signed [27:0] words_word; // its read register
    wire root_done; // u1.0
    wire [16:0] root_root; // u17.15
    wire signed [31:0] multiplier_product; // s32.0

    wire [18:0] fit_30 = {1'b0, whole[19:2]} + {18'd0, whole[1] & (whole[2] | whole[0])}; // u19.13
    wire multiplier_enable = ~(step == 4'd0); // u1.0
    wire signed [36:0] rounded = sum[41:5];
    wire signed [37:0] rounded_wide = {{1{rounded[36]}}, rounded};
    wire signed [37:0] fit_44 = rounded_wide; // s38.27
    wire among = index < 4'd14; // u1.0
    wire less_61 = step < 4'd8; // u1.0
    wire [3:0] joined_63 = {channel, less_61 ? (~(step < 4'd3)) : quadrature}; // u4.0
    wire step_is_root = step == 4'd7; // u1.0
    wire bit_71 = (~less_61) & (step < 4'd12); // u1.0
    wire step_is_restore = step == 4'd12; // u1.0
    wire channel_is_7 = channel == 3'd7; // u1.0
    wire less_77 = channel < 3'd6; // u1.0
    wire step_is_power = step == 4'd6; // u1.0
    wire [32:0] choice_82 =
        step_is_power ? ({1'd0, power} + {1'd0, multiplier_product})
        : {1'd0, multiplier_product}; // u33.30
    wire adds = ((step == 4'd3) | (step == 4'd5)) & less_77; // u1.0
    wire signed [19:0] more = {{1{total_i[18]}}, total_i} + {{4{part[15]}}, part}; // s20.15
    wire signed [20:0] fit_90 = {{1{more[19]}}, more}; // s21.15
    wire rooted = step_is_root & root_done; // u1.0
    wire channel_is_0 = channel == 3'd0; // u1.0
    wire signed [17:0] negative = 18'd0 - {1'd0, root_root}; // s18.15
    wire [3:0] sum_104 = {1'd0, channel} + 4'd1; // u4.0
    wire channel_is_6 = channel == 3'd6; // u1.0
    wire channel_is_2 = channel == 3'd2; // u1.0
    wire channel_is_3 = channel == 3'd3; // u1.0
    wire channel_is_1 = channel == 3'd1; // u1.0
    wire bit_117 = channel_is_0 | channel_is_1; // u1.0
    wire signed [20:0] choice_120 = channel_is_0 ? 21'd0 : x; // s21.15
    wire signed [17:0] choice_118 = bit_117 ? negative : {1'd0, (channel_is_2 | channel_is_3) ? root_root : 17'd0}; // s18.15
    wire signed [21:0] sum_121 = {{1{choice_120[20]}}, choice_120} + {{4{choice_118[17]}}, choice_118}; // s22.15
    wire channel_is_5 = channel == 3'd5; // u1.0
    wire channel_is_4 = channel == 3'd4; // u1.0
    wire signed [20:0] choice_132 = channel_is_0 ? 21'd0 : y; // s21.15
    wire signed [17:0] choice_131 =
        ((channel_is_1 | channel_is_2) | channel_is_4) ? negative
        : {1'd0, ((channel_is_0 | channel_is_3) | channel_is_5) ? root_root
        : 17'd0}; // s18.15
    wire signed [21:0] sum_133 = {{1{choice_132[20]}}, choice_132} + {{4{choice_131[17]}}, choice_131}; // s22.15
    wire signed [17:0] fit_140 = {1'd0, ((((bit_117 | channel_is_2) | channel_is_3) | channel_is_4) | channel_is_5) ? root_root : 17'd0}; // s18.15
    wire signed [21:0] sum_143 = {2'd0, channel_is_0 ? 20'd0 : corners} + {{4{fit_140[17]}}, fit_140}; // s22.15
    wire step_is_quadrature = step == 4'd4; // u1.0
    wire [4:0] sum_163 = {1'd0, step} + 5'd1; // u5.0
    wire [4:0] choice_166 =
        rooted ? {1'd0, channel_is_7 ? 4'd12
        : 4'd1}
        : step_is_root ? {1'd0, step}
        : sum_163; // u5.0
    wire count_is_11 = count == 4'd11; // u1.0
    wire [4:0] sum_177 = {1'd0, count} + 5'd1; // u5.0
    wire [18:0] rounded_2 = whole[19:1];
    wire [19:0] rounded_2_wide = {{1{1'b0}}, rounded_2};
    wire less_181 = count < limit; // u1.0
    wire [15:0] rounded_3 = sense_q[16:1];
    wire [16:0] rounded_3_wide = {{1{1'b0}}, rounded_3};
    wire step_is_align_move = step == 4'd10; // u1.0
    wire bit_206 = ~aligning; // u1.0
    wire bit_216 = ((step_is_align_move & bit_206) & ((long[27] & (~long[26])) | (long[26] & (~long[27])))) & less_181; // u1.0
    wire step_is_align_keep = step == 4'd11; // u1.0
    wire bit_222 = step_is_align_keep & quadrature; // u1.0
    wire bit_224 = bit_222 & (channel_is_5 | channel_is_6); // u1.0
    wire [4:0] choice_236 =
        step_is_align_move ? {1'd0, count_is_11 ? 4'd11
        : 4'd10}
        : step_is_align_keep ? {1'd0, ((quadrature & channel_is_6) & aligning) ? 4'd1
        : 4'd8}
        : sum_163; // u5.0
    wire [4:0] choice_237 = step_is_align_move ? sum_177 : 5'd0; // u5.0
    wire bit_304 = ((~(index == 4'd0)) & saturated_q) | (among & (~((fit_44[37:27] == 11'd0) | (fit_44[37:27] == 11'd2047)))); // u1.0
    wire bit_327 = valid & among; // u1.0
    wire signed [16:0] rounded_4 = {long[27], long[27:12]} + {16'd0, long[11] & (long[12] | (|long[10:0]))};
    wire bit_333 = step_is_align_keep & aligning; // u1.0
    wire [3:0] joined_334 = {channel, quadrature}; // u4.0
    wire signed [15:0] fit_331 =
        (rounded_4[16:15] == {2{rounded_4[16]}}) ? rounded_4[15:0] : {rounded_4[16], {15{~rounded_4[16]}}}; // s16.15

    root u_root (
        .clock(clock),
        .reset(reset),
        .start(root_start),
        .radicand(power),
        .done(root_done),
        .root(root_root)
    );

    multiplier_2 u_multiplier (
        .clock(clock),
        .reset(reset),
        .enable(multiplier_enable),
        .left(part),
        .right(part),
        .product(multiplier_product)
    );

    initial begin : initial_words
        integer i;
        for (i = 0; i < 16; i = i + 1) words[i] = 28'd0;
    end

    always @(posedge clock) begin
        if (arrived) words[place] <= word;
        words_word <= words[joined_63];
    end

    always @(posedge clock) begin
        if (reset) begin
            step <= 4'd0;
            arrived <= 1'd0;
            place <= 4'd0;
            word <= 28'd0;
            channel <= 3'd0;
            total_i <= 19'd0;
            total_q <= 19'd0;
            part <= 16'd0;
            power <= 32'd0;
            root_start <= 1'd0;
            sense_q <= 17'd0;
            x <= 21'd0;
            y <= 21'd0;
            corners <= 20'd0;
            least <= 17'd0;
            saturated_q <= 1'd0;
            done <= 1'd0;
            long <= 28'd0;
            count <= 4'd0;
            limit <= 4'd0;
            other <= 4'd0;
            quadrature <= 1'd0;
            aligning <= 1'd0;
            whole <= 20'd0;
        end else begin
            arrived <= bit_327 | bit_333;
            if (bit_333) begin
                place <= joined_334;
                word <= {{12{fit_331[15]}}, fit_331};
            end else if (bit_327) begin
                place <= index;
                word <=
                    (fit_44[37:27] == {11{fit_44[37]}}) ? fit_44[27:0] : {fit_44[37], {27{~fit_44[37]}}};
            end
            if (valid) begin
                channel <= 3'd0;
                total_i <= 19'd0;
                total_q <= 19'd0;
                root_start <= 1'd0;
                saturated_q <= bit_304;
                done <= 1'd0;
                count <= 4'd0;
                limit <= 4'd12;
                quadrature <= 1'd0;
                aligning <= 1'd0;
                if (index == 4'd14) begin
                    step <= 4'd8;
                end
            end else if (multiplier_enable) begin
                if (bit_71) begin
                    step <= choice_236[3:0];
                    root_start <= 1'd0;
                    done <= 1'd0;
                    long <=
                        (step == 4'd9) ? words_word
                        : (step_is_align_move & (less_181 | bit_206)) ? {long[26:0], 1'd0}
                        : long;
                    count <= choice_237[3:0];
                    quadrature <= (step_is_align_keep & (~quadrature)) | (quadrature & (~step_is_align_keep));
                    aligning <= aligning | (bit_222 & channel_is_6);
                    if (bit_222) begin
                        channel <= channel_is_6 ? 3'd0 : sum_104[2:0];
                    end
                    if (bit_224) begin
                        limit <= ((bit_224 & channel_is_5) & bit_206) ? 4'd12 : other;
                        other <= limit;
                    end else if (bit_216) begin
                        limit <= count;
                    end
                end else if (step_is_restore) begin
                    root_start <= 1'd0;
                    done <= count_is_11;
                    count <= sum_177[3:0];
                    if (less_181) begin
                        whole <= rounded_2_wide;
                    end
                    if (count < other) begin
                        sense_q <= rounded_3_wide;
                    end
                    if (count_is_11) begin
                        step <= 4'd0;
                    end
                end else begin
                    step <= choice_166[3:0];
                    part <=
                        (step == 4'd2) ? (channel_is_7 ? (total_i[18:3] + {15'd0, total_i[2] & (total_i[3] | (|total_i[1:0]))})
                        : words_word[15:0])
                        : step_is_quadrature ? (channel_is_7 ? (total_q[18:3] + {15'd0, total_q[2] & (total_q[3] | (|total_q[1:0]))})
                        : words_word[15:0])
                        : part;
                    root_start <= step_is_power;
                    saturated_q <= saturated_q | (adds & (~((fit_90[20:18] == 3'd0) | (fit_90[20:18] == 3'd7))));
                    done <= 1'd0;
                    if (step_is_quadrature | step_is_power) begin
                        power <= choice_82[31:0];
                    end
                    if (adds) begin
                        total_i <= total_q;
                        total_q <=
                            (fit_90[20:18] == {3{fit_90[20]}}) ? fit_90[18:0] : {fit_90[20], {18{~fit_90[20]}}};
                    end
                    if (rooted) begin
                        channel <= sum_104[2:0];
                        x <= sum_121[20:0];
                        y <= sum_133[20:0];
                        corners <= sum_143[19:0];
                        whole <= {root_root, 3'd0};
                        if (channel_is_0 | (less_77 & (root_root < least))) begin
                            least <= root_root;
                        end
                        if (channel_is_6) begin
                            sense_q <= root_root;
                        end
                    end
                end
            end else begin
                root_start <= 1'd0;
                done <= 1'd0;
            end
        end
    end

    assign total = (|fit_30[18:16]) ? {16{1'b1}} : fit_30[15:0];
    assign sense = {1'b0, sense_q[16:2]} + {15'd0, sense_q[1] & (sense_q[2] | sense_q[0])};
    assign saturated = saturated_q | (~(fit_30[18:16] == 3'd0));

    // What nothing needs.
    wire unused = &{1'b0, sum[4:0], choice_82[32], sum_104[3], sum_121[21], sum_133[21], sum_143[21:20],
        choice_166[4], choice_236[4], choice_237[4]};

endmodule

`default_nettype wire

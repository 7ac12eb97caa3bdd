// currents: hapticore_model::blocks::currents::Currents
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module currents (
    input wire clock,
    input wire reset,
    input wire valid, // u1.0  A sum is there.
    input wire [3:0] index, // u4.0  Which.
    input wire signed [44:0] sum, // s45.34  The sum.
    output reg done, // u1.0  Set for one clock when all others are there.
    output wire [26:0] total, // u27.23  The amplitude of the total current.
    output reg [26:0] sense, // u27.23  The amplitude of the sensing voltage.
    output reg signed [30:0] x, // s31.23  The numerator of r_x.
    output reg signed [30:0] y, // s31.23  The numerator of r_y.
    output reg [29:0] corners, // u30.23  Their denominator.
    output reg [26:0] least, // u27.23  The least amplitude of the terminals, in the unit of the numerators.
    output reg saturated // u1.0  Whether a word is held at a rail.
);

    reg [2:0] step; // u3.0  0 idle, 1 read, 2 in_phase, 3 read_quadrature, 4 quadrature, 5 square, 6 power, 7 root, 8 align_read, 9 align_load, 10 align_move, 11 align_keep, 12 restore
    reg arrived; // u1.0
    reg [3:0] place; // u4.0
    reg signed [23:0] word; // s24.23
    reg waited; // u1.0
    reg [2:0] channel; // u3.0
    reg signed [25:0] total_i; // s26.23
    reg signed [25:0] total_q; // s26.23
    reg signed [25:0] part; // s26.23
    reg [51:0] power; // u52.46
    reg root_start; // u1.0
    (* no_rw_check *) // nobody uses a word that was read while it was being written
    reg signed [23:0] words [0:15]; // 16 words s24.23
    reg signed [23:0] words_word; // its read register
    wire root_done; // u1.0
    wire [26:0] root_root; // u27.23
    wire signed [51:0] multiplier_product; // s52.0

    wire multiplier_enable = ~(step == 3'd0); // u1.0
    wire signed [26:0] fit_37 = {sum[44], sum[44:19]} + {26'd0, sum[18] & (sum[19] | (|sum[17:0]))}; // s27.23
    wire among = index < 4'd14; // u1.0
    wire [3:0] joined_53 = {channel, ~(step < 3'd3)}; // u4.0
    wire step_is_root = step == 3'd7; // u1.0
    wire bit_58 = waited | step_is_root; // u1.0
    wire channel_is_7 = channel == 3'd7; // u1.0
    wire less_61 = channel < 3'd6; // u1.0
    wire step_is_power = step == 3'd6; // u1.0
    wire [52:0] choice_66 =
        step_is_power ? ({1'd0, power} + {1'd0, multiplier_product})
        : {1'd0, multiplier_product}; // u53.46
    wire adds = ((step == 3'd3) | (step == 3'd5)) & less_61; // u1.0
    wire signed [26:0] more = {{1{total_i[25]}}, total_i} + {{1{part[25]}}, part}; // s27.23
    wire signed [27:0] fit_74 = {{1{more[26]}}, more}; // s28.23
    wire rooted = step_is_root & root_done; // u1.0
    wire channel_is_0 = channel == 3'd0; // u1.0
    wire signed [27:0] negative = 28'd0 - {1'd0, root_root}; // s28.23
    wire [3:0] sum_88 = {1'd0, channel} + 4'd1; // u4.0
    wire channel_is_2 = channel == 3'd2; // u1.0
    wire channel_is_3 = channel == 3'd3; // u1.0
    wire channel_is_1 = channel == 3'd1; // u1.0
    wire bit_99 = channel_is_0 | channel_is_1; // u1.0
    wire signed [30:0] choice_102 = channel_is_0 ? 31'd0 : x; // s31.23
    wire signed [27:0] choice_100 = bit_99 ? negative : {1'd0, (channel_is_2 | channel_is_3) ? root_root : 27'd0}; // s28.23
    wire signed [31:0] sum_103 = {{1{choice_102[30]}}, choice_102} + {{4{choice_100[27]}}, choice_100}; // s32.23
    wire channel_is_5 = channel == 3'd5; // u1.0
    wire channel_is_4 = channel == 3'd4; // u1.0
    wire signed [30:0] choice_114 = channel_is_0 ? 31'd0 : y; // s31.23
    wire signed [27:0] choice_113 =
        ((channel_is_1 | channel_is_2) | channel_is_4) ? negative
        : {1'd0, ((channel_is_0 | channel_is_3) | channel_is_5) ? root_root
        : 27'd0}; // s28.23
    wire signed [31:0] sum_115 = {{1{choice_114[30]}}, choice_114} + {{4{choice_113[27]}}, choice_113}; // s32.23
    wire signed [27:0] fit_122 = {1'd0, ((((bit_99 | channel_is_2) | channel_is_3) | channel_is_4) | channel_is_5) ? root_root : 27'd0}; // s28.23
    wire signed [31:0] sum_125 = {2'd0, channel_is_0 ? 30'd0 : corners} + {{4{fit_122[27]}}, fit_122}; // s32.23
    wire step_is_quadrature = step == 3'd4; // u1.0
    wire [3:0] choice_143 =
        rooted ? {3'd0, channel_is_7 ? 1'd0
        : 1'd1}
        : step_is_root ? {1'd0, step}
        : ({1'd0, step} + 4'd1); // u4.0
    wire bit_189 = ((~(index == 4'd0)) & saturated) | (among & (~((fit_37[26:23] == 4'd0) | (fit_37[26:23] == 4'd15)))); // u1.0
    wire next_arrived = valid & among; // u1.0

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
        for (i = 0; i < 16; i = i + 1) words[i] = 24'd0;
    end

    always @(posedge clock) begin
        if (arrived) words[place] <= word;
        words_word <= words[joined_53];
    end

    always @(posedge clock) begin
        if (reset) begin
            step <= 3'd0;
            arrived <= 1'd0;
            place <= 4'd0;
            word <= 24'd0;
            waited <= 1'd0;
            channel <= 3'd0;
            total_i <= 26'd0;
            total_q <= 26'd0;
            part <= 26'd0;
            power <= 52'd0;
            root_start <= 1'd0;
            sense <= 27'd0;
            x <= 31'd0;
            y <= 31'd0;
            corners <= 30'd0;
            least <= 27'd0;
            saturated <= 1'd0;
            done <= 1'd0;
        end else begin
            arrived <= next_arrived;
            if (next_arrived) begin
                place <= index;
                word <=
                    (fit_37[26:23] == {4{fit_37[26]}}) ? fit_37[23:0] : {fit_37[26], {23{~fit_37[26]}}};
            end
            if (valid) begin
                waited <= 1'd0;
                channel <= 3'd0;
                total_i <= 26'd0;
                total_q <= 26'd0;
                root_start <= 1'd0;
                saturated <= bit_189;
                done <= 1'd0;
                if (index == 4'd14) begin
                    step <= 3'd1;
                end
            end else if (multiplier_enable) begin
                if (bit_58) begin
                    step <= choice_143[2:0];
                    waited <= 1'd0;
                    part <=
                        (step == 3'd2) ? (channel_is_7 ? total_i
                        : {{2{words_word[23]}}, words_word})
                        : step_is_quadrature ? (channel_is_7 ? total_q
                        : {{2{words_word[23]}}, words_word})
                        : part;
                    root_start <= step_is_power;
                    saturated <= saturated | (adds & (~((fit_74[27:25] == 3'd0) | (fit_74[27:25] == 3'd7))));
                    done <= rooted & channel_is_7;
                    if (step_is_quadrature | step_is_power) begin
                        power <= choice_66[51:0];
                    end
                    if (adds) begin
                        total_i <= total_q;
                        total_q <=
                            (fit_74[27:25] == {3{fit_74[27]}}) ? fit_74[25:0] : {fit_74[27], {25{~fit_74[27]}}};
                    end
                    if (rooted) begin
                        channel <= sum_88[2:0];
                        x <= sum_103[30:0];
                        y <= sum_115[30:0];
                        corners <= sum_125[29:0];
                        if (channel_is_0 | (less_61 & (root_root < least))) begin
                            least <= root_root;
                        end
                        if (channel == 3'd6) begin
                            sense <= root_root;
                        end
                    end
                end else begin
                    waited <= 1'd1;
                    root_start <= 1'd0;
                    done <= 1'd0;
                end
            end else begin
                root_start <= 1'd0;
                done <= 1'd0;
            end
        end
    end

    assign total = root_root;

    // What nothing needs.
    wire unused = &{1'b0, choice_66[52], sum_88[3], sum_103[31], sum_115[31], sum_125[31:30], choice_143[3]};

endmodule

`default_nettype wire

// position: hapticore_model::blocks::position::Position
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module position (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  Begins; the ratios are valid and stable until `done`.
    input wire signed [17:0] r_x, // s18.16  The x ratio.
    input wire signed [17:0] r_y, // s18.16  The y ratio.
    input wire [16:0] share, // u17.16  The least current's share of the ratios' denominator.
    input wire write, // u1.0  Calibration: writes a word of the position table.
    input wire [10:0] address, // u11.0  Calibration: the word's address.
    input wire signed [15:0] word, // s16.15  Calibration: the word.
    output reg done, // u1.0  Asserted for one cycle when the others are valid.
    output reg signed [15:0] x, // s16.5  The position along the long edges, in mm.
    output reg signed [15:0] y, // s16.5  The position along the short edges, in mm.
    output reg [14:0] sheet, // u15.15  The sheet's resistance at the pad, in full scales of voltage per current.
    output reg invalid, // u1.0  No place of the table has the measured ratios.
    output reg lost, // u1.0  A terminal's current is that of an open one.
    output reg saturated // u1.0  A position is saturated.
);

    reg running; // u1.0
    reg bubble; // u1.0
    reg [7:0] fetched; // u8.0
    reg [15:0] instruction; // u16.0
    reg [1:0] waited; // u2.0
    reg loads; // u1.0
    reg floors; // u1.0
    reg digits; // u1.0
    reg multiplies; // u1.0
    reg tables; // u1.0
    reg [1:0] pending; // u2.0
    reg signed [15:0] left; // s16.15
    reg signed [15:0] factor; // s16.15
    reg signed [15:0] word_q; // s16.15
    reg signed [37:0] sum; // s38.30
    reg [12:0] quotient; // u13.0
    reg [10:0] base; // u11.0
    reg [1:0] surface; // u2.0  0 r_x, 1 r_y, 2 resistance
    reg [3:0] count; // u4.0
    reg [2:0] step; // u3.0
    (* no_rw_check *) // nobody uses a word that was read while it was being written
    reg signed [15:0] words [0:1498]; // 1499 words s16.15
    reg signed [15:0] words_word; // its read register
    (* no_rw_check *) // nobody uses a word that was read while it was being written
    (* ram_style = "block" *)
    reg signed [15:0] scratch [0:127]; // 128 words s16.15
    reg signed [15:0] scratch_word; // its read register
    reg [15:0] instructions [0:233]; // 234 words u16.0
    reg [15:0] instructions_word; // its read register
    wire signed [31:0] multiplier_product; // s32.0

    wire is_base = instruction[15:12] == 4'd7; // u1.0
    wire is_load_digit = instruction[15:12] == 4'd5; // u1.0
    wire is_load_quotient = instruction[15:12] == 4'd2; // u1.0
    wire is_output = instruction[15:12] == 4'd9; // u1.0
    wire is_store = instruction[15:12] == 4'd6; // u1.0
    wire waits = (((is_base | is_load_digit) | is_load_quotient) | is_output) | is_store; // u1.0
    wire does = (running & (~bubble)) & ((~waits) | (waited == 2'd3)); // u1.0
    wire [1:0] bits_62 = instruction[11:10]; // u2.0
    wire [3:0] of_group =
        bits_62[1] ? (bits_62[0] ? {2'd0, {surface[0], 1'd0}}
        : count)
        : bits_62[0] ? {2'd0, surface}
        : is_load_digit ? {3'd0, sum[37]}
        : 4'd0; // u4.0
    wire [6:0] bits_61 = instruction[9:3]; // u7.0
    wire [3:0] bits_76 = bits_61[3:0]; // u4.0
    wire [3:0] joined_91 = {{{bits_76[3] | of_group[3], bits_76[2] | of_group[2]}, bits_76[1] | of_group[1]}, bits_76[0] | of_group[0]}; // u4.0
    wire [6:0] slot = {bits_61[6:4], joined_91}; // u7.0
    wire signed [22:0] rounded = sum[37:15];
    wire signed [23:0] rounded_wide = {{1{rounded[22]}}, rounded};
    wire signed [23:0] fit_94 = rounded_wide; // s24.15
    wire signed [15:0] result =
        (fit_94[23:15] == {9{fit_94[23]}}) ? fit_94[15:0] : {fit_94[23], {15{~fit_94[23]}}}; // s16.15
    wire held = ~((fit_94[23:15] == 9'd0) | (fit_94[23:15] == 9'd511)); // u1.0
    wire is_multiply_table = instruction[15:12] == 4'd4; // u1.0
    wire [11:0] sum_109 = {1'd0, base} + {9'd0, is_multiply_table ? instruction[2:0] : 3'd0}; // u12.0
    wire bit_111 = does & is_store; // u1.0
    wire is_input = instruction[15:12] == 4'd8; // u1.0
    wire [2:0] bits_38 = instruction[2:0]; // u3.0
    wire signed [17:0] choice_120 = bits_38[1] ? {1'd0, share} : surface[0] ? r_y : r_x; // s18.16
    wire [8:0] sum_131 = {1'd0, fetched} + 9'd1; // u9.0
    wire is_repeat = instruction[15:12] == 4'd11; // u1.0
    wire bit_138 = (does & is_repeat) & (~(count == 4'd0)); // u1.0
    wire is_surfaces = instruction[15:12] == 4'd12; // u1.0
    wire bit_141 = does & is_surfaces; // u1.0
    wire surface_is_r_x = surface == 2'd0; // u1.0
    wire is_pass = instruction[15:12] == 4'd13; // u1.0
    wire bit_146 = does & is_pass; // u1.0
    wire is_found = instruction[15:12] == 4'd14; // u1.0
    wire step_is_7 = step == 3'd7; // u1.0
    wire jumps = ((bit_138 | (bit_141 & surface_is_r_x)) | (bit_146 & (~(step == 3'd6)))) | ((does & is_found) & step_is_7); // u1.0
    wire bit_158 = does | bubble; // u1.0
    wire is_end = instruction[15:12] == 4'd15; // u1.0
    wire next_done = does & is_end; // u1.0
    wire bit_165 = running & (~next_done); // u1.0
    wire [7:0] fetch = bit_165 ? (jumps ? instruction[7:0] : bit_158 ? sum_131[7:0] : fetched) : 8'd0; // u8.0
    wire bit_174 = does & is_load_digit; // u1.0
    wire next_digits = does & is_load_quotient; // u1.0
    wire is_load = instruction[15:12] == 4'd0; // u1.0
    wire is_load_cell = instruction[15:12] == 4'd1; // u1.0
    wire next_floors = does & is_load_cell; // u1.0
    wire next_tables = does & is_multiply_table; // u1.0
    wire signed [38:0] sum_184 = {{1{sum[37]}}, sum} + {{7{multiplier_product[31]}}, multiplier_product}; // s39.30
    wire bit_187 = does & is_output; // u1.0
    wire signed [12:0] fit_197 = {~quotient[12], quotient[11:0]}; // s13.0
    wire is_multiply = instruction[15:12] == 4'd3; // u1.0
    wire [2:0] joined_200 = {pending, multiplies}; // u3.0
    wire [13:0] joined_210 = {quotient, ~sum[37]}; // u14.0
    wire is_set = instruction[15:12] == 4'd10; // u1.0
    wire bit_217 = does & is_set; // u1.0
    wire signed [4:0] difference_227 = {1'd0, count} - 5'd1; // s5.0
    wire [2:0] sum_233 = {1'd0, waited} + 3'd1; // u3.0
    wire [3:0] sum_243 = {1'd0, step} + 4'd1; // u4.0
    wire bit_246 = bit_187 & surface_is_r_x; // u1.0
    wire surface_is_r_y = surface == 2'd1; // u1.0
    wire bit_248 = bit_187 & surface_is_r_y; // u1.0

    multiplier_2 u_multiplier (
        .clock(clock),
        .reset(reset),
        .enable(pending[0]),
        .left(factor),
        .right(word_q),
        .product(multiplier_product)
    );

    initial begin : initial_words
        integer i;
        for (i = 0; i < 1499; i = i + 1) words[i] = 16'd0;
    end

    always @(posedge clock) begin
        if (write) words[address] <= word;
        words_word <= words[sum_109[10:0]];
    end

    initial begin : initial_scratch
        scratch[0] = 16'h0004; scratch[1] = 16'h0008; scratch[2] = 16'h0010; scratch[3] = 16'h0020;
        scratch[4] = 16'h0040; scratch[5] = 16'h0080; scratch[6] = 16'h0100; scratch[7] = 16'h0200;
        scratch[8] = 16'h0400; scratch[9] = 16'h0800; scratch[10] = 16'h1000; scratch[11] = 16'h2000;
        scratch[12] = 16'h4000; scratch[13] = 16'h0000; scratch[14] = 16'h0000; scratch[15] = 16'h0000;
        scratch[16] = 16'h4000; scratch[17] = 16'hc000; scratch[18] = 16'h8000; scratch[19] = 16'h2000;
        scratch[20] = 16'h0000; scratch[21] = 16'h1000; scratch[22] = 16'h0000; scratch[23] = 16'h0400;
        scratch[24] = 16'h0020; scratch[25] = 16'h2000; scratch[26] = 16'h3a00; scratch[27] = 16'h5e00;
        scratch[28] = 16'h4000; scratch[29] = 16'hc000; scratch[30] = 16'hc000; scratch[31] = 16'h4000;
        scratch[32] = 16'h04a0; scratch[33] = 16'h04a0; scratch[34] = 16'h0160; scratch[35] = 16'hffff;
        scratch[36] = 16'hfeb7; scratch[37] = 16'hfbf8; scratch[38] = 16'hfa58; scratch[39] = 16'h0000;
        scratch[40] = 16'h0000; scratch[41] = 16'h0000; scratch[42] = 16'h0000; scratch[43] = 16'h0000;
        scratch[44] = 16'h0000; scratch[45] = 16'h0000; scratch[46] = 16'h0000; scratch[47] = 16'h0000;
        scratch[48] = 16'h0000; scratch[49] = 16'h0000; scratch[50] = 16'h0000; scratch[51] = 16'h0000;
        scratch[52] = 16'h0000; scratch[53] = 16'h0000; scratch[54] = 16'h0000; scratch[55] = 16'h0000;
        scratch[56] = 16'h0000; scratch[57] = 16'h0000; scratch[58] = 16'h0000; scratch[59] = 16'h0000;
        scratch[60] = 16'h0000; scratch[61] = 16'h0000; scratch[62] = 16'h0000; scratch[63] = 16'h0000;
        scratch[64] = 16'h0000; scratch[65] = 16'h0000; scratch[66] = 16'h0000; scratch[67] = 16'h0000;
        scratch[68] = 16'h0000; scratch[69] = 16'h0000; scratch[70] = 16'h0000; scratch[71] = 16'h0000;
        scratch[72] = 16'h0000; scratch[73] = 16'h0000; scratch[74] = 16'h0000; scratch[75] = 16'h0000;
        scratch[76] = 16'h0000; scratch[77] = 16'h0000; scratch[78] = 16'h0000; scratch[79] = 16'h0000;
        scratch[80] = 16'h0000; scratch[81] = 16'h0000; scratch[82] = 16'h0000; scratch[83] = 16'h0000;
        scratch[84] = 16'h0000; scratch[85] = 16'h0000; scratch[86] = 16'h0000; scratch[87] = 16'h0000;
        scratch[88] = 16'h0000; scratch[89] = 16'h0000; scratch[90] = 16'h0000; scratch[91] = 16'h0000;
        scratch[92] = 16'h0000; scratch[93] = 16'h0000; scratch[94] = 16'h0000; scratch[95] = 16'h0000;
        scratch[96] = 16'h0000; scratch[97] = 16'h0000; scratch[98] = 16'h0000; scratch[99] = 16'h0000;
        scratch[100] = 16'h0000; scratch[101] = 16'h0000; scratch[102] = 16'h0000; scratch[103] = 16'h0000;
        scratch[104] = 16'h0000; scratch[105] = 16'h0000; scratch[106] = 16'h0000; scratch[107] = 16'h0000;
        scratch[108] = 16'h0000; scratch[109] = 16'h0000; scratch[110] = 16'h0000; scratch[111] = 16'h0000;
        scratch[112] = 16'h0000; scratch[113] = 16'h0000; scratch[114] = 16'h0000; scratch[115] = 16'h0000;
        scratch[116] = 16'h0000; scratch[117] = 16'h0000; scratch[118] = 16'h0000; scratch[119] = 16'h0000;
        scratch[120] = 16'h0000; scratch[121] = 16'h0000; scratch[122] = 16'h0000; scratch[123] = 16'h0000;
        scratch[124] = 16'h0000; scratch[125] = 16'h0000; scratch[126] = 16'h0000; scratch[127] = 16'h0000;
    end

    always @(posedge clock) begin
        if (bit_111 | (does & is_input)) scratch[slot] <= is_input ? (bits_38[0] ? {1'd0, choice_120[1:0], 13'd0} : choice_120[17:2]) : bits_38[0] ? sum[30:15] : result;
        scratch_word <= scratch[slot];
    end

    initial begin : initial_instructions
        instructions[0] = 16'ha004; instructions[1] = 16'h822a; instructions[2] = 16'h0080; instructions[3] = 16'h3228;
        instructions[4] = 16'h3228; instructions[5] = 16'h4097; instructions[6] = 16'h622c; instructions[7] = 16'ha004;
        instructions[8] = 16'h8540; instructions[9] = 16'h8229; instructions[10] = 16'h4228; instructions[11] = 16'h6228;
        instructions[12] = 16'h0080; instructions[13] = 16'h3540; instructions[14] = 16'h3540; instructions[15] = 16'h4091;
        instructions[16] = 16'h6540; instructions[17] = 16'ha079; instructions[18] = 16'h4540; instructions[19] = 16'h4540;
        instructions[20] = 16'hb012; instructions[21] = 16'h00c0; instructions[22] = 16'h3228; instructions[23] = 16'h6540;
        instructions[24] = 16'hc007; instructions[25] = 16'ha004; instructions[26] = 16'ha019; instructions[27] = 16'h4092;
        instructions[28] = 16'h4143; instructions[29] = 16'h414c; instructions[30] = 16'hb01b; instructions[31] = 16'h6550;
        instructions[32] = 16'h0080; instructions[33] = 16'h3550; instructions[34] = 16'h3550; instructions[35] = 16'h34d0;
        instructions[36] = 16'h34d0; instructions[37] = 16'h6550; instructions[38] = 16'h3550; instructions[39] = 16'h3550;
        instructions[40] = 16'h0090; instructions[41] = 16'h34d0; instructions[42] = 16'h34d0; instructions[43] = 16'h6550;
        instructions[44] = 16'h0080; instructions[45] = 16'h3550; instructions[46] = 16'h3550; instructions[47] = 16'h34d0;
        instructions[48] = 16'h34d0; instructions[49] = 16'h6550; instructions[50] = 16'hc019; instructions[51] = 16'h0080;
        instructions[52] = 16'h3550; instructions[53] = 16'h3550; instructions[54] = 16'h30b8; instructions[55] = 16'h6560;
        instructions[56] = 16'h0550; instructions[57] = 16'h3090; instructions[58] = 16'h3090; instructions[59] = 16'h3090;
        instructions[60] = 16'h3090; instructions[61] = 16'h3090; instructions[62] = 16'h3090; instructions[63] = 16'h3090;
        instructions[64] = 16'h3090; instructions[65] = 16'h6211; instructions[66] = 16'h0210; instructions[67] = 16'h3090;
        instructions[68] = 16'h3090; instructions[69] = 16'h3090; instructions[70] = 16'h3090; instructions[71] = 16'h3090;
        instructions[72] = 16'h3090; instructions[73] = 16'h3090; instructions[74] = 16'h3090; instructions[75] = 16'h6211;
        instructions[76] = 16'h0090; instructions[77] = 16'h3210; instructions[78] = 16'h65c0; instructions[79] = 16'h0210;
        instructions[80] = 16'h3210; instructions[81] = 16'h6218; instructions[82] = 16'h0098; instructions[83] = 16'h3080;
        instructions[84] = 16'h35c0; instructions[85] = 16'h00a8; instructions[86] = 16'h3218; instructions[87] = 16'h6580;
        instructions[88] = 16'h0098; instructions[89] = 16'h3080; instructions[90] = 16'h3210; instructions[91] = 16'h00a8;
        instructions[92] = 16'h3218; instructions[93] = 16'h65a0; instructions[94] = 16'h0090; instructions[95] = 16'h3090;
        instructions[96] = 16'h3580; instructions[97] = 16'h35a0; instructions[98] = 16'h6590; instructions[99] = 16'h0080;
        instructions[100] = 16'h3210; instructions[101] = 16'h3090; instructions[102] = 16'h65b0; instructions[103] = 16'h3210;
        instructions[104] = 16'h0088; instructions[105] = 16'h3090; instructions[106] = 16'h65d0; instructions[107] = 16'hc033;
        instructions[108] = 16'h1160; instructions[109] = 16'h30c0; instructions[110] = 16'h1168; instructions[111] = 16'h3500;
        instructions[112] = 16'h0090; instructions[113] = 16'h3520; instructions[114] = 16'h6220; instructions[115] = 16'ha011;
        instructions[116] = 16'h0080; instructions[117] = 16'h3220; instructions[118] = 16'h3220; instructions[119] = 16'h7000;
        instructions[120] = 16'h00b8; instructions[121] = 16'h3500; instructions[122] = 16'h6220; instructions[123] = 16'h4180;
        instructions[124] = 16'h4191; instructions[125] = 16'h41a2; instructions[126] = 16'h6a40; instructions[127] = 16'h41b0;
        instructions[128] = 16'h41c1; instructions[129] = 16'h41d2; instructions[130] = 16'h6a60; instructions[131] = 16'hb074;
        instructions[132] = 16'h0188; instructions[133] = 16'h3250; instructions[134] = 16'h0198; instructions[135] = 16'h3248;
        instructions[136] = 16'h01a8; instructions[137] = 16'h3240; instructions[138] = 16'he0e7; instructions[139] = 16'h0090;
        instructions[140] = 16'h3540; instructions[141] = 16'h6572; instructions[142] = 16'h3570; instructions[143] = 16'h6570;
        instructions[144] = 16'h0188; instructions[145] = 16'h3270; instructions[146] = 16'h0198; instructions[147] = 16'h3268;
        instructions[148] = 16'h01a8; instructions[149] = 16'h3260; instructions[150] = 16'h6228; instructions[151] = 16'h04e0;
        instructions[152] = 16'h3228; instructions[153] = 16'h3228; instructions[154] = 16'h6de8; instructions[155] = 16'h01b8;
        instructions[156] = 16'h3250; instructions[157] = 16'h01c8; instructions[158] = 16'h3248; instructions[159] = 16'h01d8;
        instructions[160] = 16'h3240; instructions[161] = 16'h6228; instructions[162] = 16'h04f0; instructions[163] = 16'h3228;
        instructions[164] = 16'h3228; instructions[165] = 16'h6de0; instructions[166] = 16'hc06c; instructions[167] = 16'h0090;
        instructions[168] = 16'h31f8; instructions[169] = 16'h6228; instructions[170] = 16'ha019; instructions[171] = 16'h01e8;
        instructions[172] = 16'h31f0; instructions[173] = 16'h01e0; instructions[174] = 16'h3228; instructions[175] = 16'hb0ab;
        instructions[176] = 16'h6208; instructions[177] = 16'h0090; instructions[178] = 16'h3208; instructions[179] = 16'h6200;
        instructions[180] = 16'h05f0; instructions[181] = 16'h3170; instructions[182] = 16'h05e0; instructions[183] = 16'h3178;
        instructions[184] = 16'h0208; instructions[185] = 16'h3000; instructions[186] = 16'h0080; instructions[187] = 16'h3118;
        instructions[188] = 16'ha061; instructions[189] = 16'h5200; instructions[190] = 16'h3800; instructions[191] = 16'hb0bd;
        instructions[192] = 16'h2000; instructions[193] = 16'h6228; instructions[194] = 16'h3080; instructions[195] = 16'h3080;
        instructions[196] = 16'h0080; instructions[197] = 16'h3550; instructions[198] = 16'h3550; instructions[199] = 16'h6550;
        instructions[200] = 16'h0080; instructions[201] = 16'h3550; instructions[202] = 16'h3550; instructions[203] = 16'h34d0;
        instructions[204] = 16'h34d0; instructions[205] = 16'h6550; instructions[206] = 16'h3550; instructions[207] = 16'h3550;
        instructions[208] = 16'h0090; instructions[209] = 16'h34d0; instructions[210] = 16'h34d0; instructions[211] = 16'h6550;
        instructions[212] = 16'h0080; instructions[213] = 16'h3550; instructions[214] = 16'h3550; instructions[215] = 16'h34d0;
        instructions[216] = 16'h34d0; instructions[217] = 16'h6550; instructions[218] = 16'hc0b4; instructions[219] = 16'hd033;
        instructions[220] = 16'ha004; instructions[221] = 16'h4555; instructions[222] = 16'h4555; instructions[223] = 16'h4096;
        instructions[224] = 16'h9000; instructions[225] = 16'h00c8; instructions[226] = 16'h3550; instructions[227] = 16'h6550;
        instructions[228] = 16'hc0dc; instructions[229] = 16'ha002; instructions[230] = 16'he033; instructions[231] = 16'h9000;
        instructions[232] = 16'hf000; instructions[233] = 16'hf000;
    end

    always @(posedge clock) begin
        instructions_word <= instructions[fetch];
    end

    always @(posedge clock) begin
        if (reset) begin
            running <= 1'd0;
            bubble <= 1'd0;
            fetched <= 8'd0;
            instruction <= 16'd0;
            waited <= 2'd0;
            loads <= 1'd0;
            floors <= 1'd0;
            digits <= 1'd0;
            multiplies <= 1'd0;
            tables <= 1'd0;
            pending <= 2'd0;
            left <= 16'd0;
            factor <= 16'd0;
            word_q <= 16'd0;
            sum <= 38'd0;
            quotient <= 13'd0;
            base <= 11'd0;
            surface <= 2'd0;
            count <= 4'd0;
            step <= 3'd0;
            x <= 16'd0;
            y <= 16'd0;
            sheet <= 15'd0;
            invalid <= 1'd0;
            lost <= 1'd0;
            saturated <= 1'd0;
            done <= 1'd0;
        end else begin
            fetched <= fetch;
            waited <= (bit_158 | (~running)) ? 2'd0 : sum_233[1:0];
            loads <= (((does & is_load) | next_floors) | bit_174) | next_digits;
            floors <= next_floors;
            digits <= next_digits;
            multiplies <= (does & is_multiply) | next_tables;
            tables <= next_tables;
            pending <= joined_200[1:0];
            base <=
                (bit_217 & bits_38[2]) ? {7'd0, {surface[0], 3'd0}}
                : (does & is_base) ? sum[25:15]
                : base;
            count <=
                (bit_217 & bits_38[0]) ? instruction[6:3]
                : bit_138 ? difference_227[3:0]
                : count;
            done <= next_done;
            if (bit_111 & bits_38[2]) begin
                lost <= result < $signed(16'd0);
            end
            if (bit_187 & (surface == 2'd2)) begin
                sheet <= result[15] ? 15'd0 : result[14:0];
            end
            if (bit_248) begin
                y <= result;
            end
            if (bit_246) begin
                x <= result;
            end
            if (loads) begin
                left <=
                    digits ? {{3{fit_197[12]}}, fit_197}
                    : floors ? {scratch_word[15:10], 10'd0}
                    : scratch_word;
            end
            if (bit_158) begin
                instruction <= instructions_word;
            end
            if (multiplies) begin
                factor <= tables ? words_word : left;
                word_q <= scratch_word;
            end
            if (start) begin
                running <= 1'd1;
                bubble <= 1'd1;
                sum <= 38'd16384;
                quotient <= 13'd0;
                surface <= 2'd0;
                step <= 3'd0;
                invalid <= 1'd0;
                saturated <= 1'd0;
            end else begin
                running <= bit_165;
                bubble <= jumps;
                sum <= (bit_111 | bit_187) ? 38'd16384 : pending[1] ? sum_184[37:0] : sum;
                surface <=
                    (bit_217 & bits_38[1]) ? 2'd0
                    : bit_141 ? (surface_is_r_x ? 2'd1
                    : step_is_7 ? 2'd2
                    : 2'd0)
                    : surface;
                saturated <= saturated | ((bit_246 | bit_248) & held);
                if (bit_111 & bits_38[1]) begin
                    invalid <= (surface_is_r_y & invalid) | (~((result[15:6] == 10'd0) | (result[15:6] == 10'd1023)));
                end
                if (bit_146) begin
                    step <= sum_243[2:0];
                end
                if (bit_174) begin
                    quotient <= joined_210[12:0];
                end
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_109[11], sum_131[8], sum_184[38], joined_200[2], joined_210[13], difference_227[4],
        sum_233[2], sum_243[3]};

endmodule

`default_nettype wire

// oscillator: hapticore_model::blocks::oscillator::Oscillator
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module oscillator (
    input wire clock,
    input wire reset,
    input wire sample, // u1.0  A sample is there.
    input wire restart, // u1.0  It is the first of its slot.
    input wire first, // u1.0  It is the first of its window.
    output reg ready, // u1.0  Set for one clock before the other outputs are those of the sample.
    output reg signed [17:0] cosine, // s18.17  The cosine of the carrier.
    output reg signed [17:0] sine, // s18.17  The sine of the carrier.
    output reg signed [17:0] window, // s18.17  The window.
    output wire phase // u1.0  Polyphase: which of the carrier's five phases the sample has.
);

    reg [2:0] step; // u3.0  0 idle, 1 look_up, 2 wave, 3 cosine, 4 sine
    reg [1:0] quadrant; // u2.0
    reg [7:0] phase_q; // u8.0
    reg [1:0] window_quadrant; // u2.0
    reg [7:0] window_phase; // u8.0
    reg negative; // u1.0
    reg [16:0] wave; // u17.17
    reg sign; // u1.0
    reg residue; // u1.0
    reg [16:0] quarter [0:250]; // 251 words u17.17
    reg [16:0] quarter_word; // its read register

    wire bit_18 = ~(step == 3'd0); // u1.0
    wire bit_22 = sample & first; // u1.0
    wire step_is_wave = step == 3'd2; // u1.0
    wire bit_28 = (step == 3'd1) | step_is_wave; // u1.0
    wire [1:0] choice_29 = bit_28 ? quadrant : bit_22 ? 2'd0 : window_quadrant; // u2.0
    wire [2:0] sum_30 = {1'd0, choice_29} + 3'd1; // u3.0
    wire [1:0] choice_32 = step_is_wave ? choice_29 : sum_30[1:0]; // u2.0
    wire [7:0] choice_34 = bit_28 ? phase_q : bit_22 ? 8'd0 : window_phase; // u8.0
    wire signed [8:0] difference_36 = 9'd250 - {1'd0, choice_34}; // s9.0
    wire step_is_sine = step == 3'd4; // u1.0
    wire [8:0] sum_44 = {1'd0, phase_q} + 9'd101; // u9.0
    wire bit_46 = ~(sum_44 < 9'd250); // u1.0
    wire signed [9:0] difference_47 = {1'd0, sum_44} - 10'd250; // s10.0
    wire [2:0] sum_50 = {1'd0, quadrant} + {2'd0, bit_46 ? 1'd1 : 1'd0}; // u3.0
    wire [8:0] sum_56 = {1'd0, window_phase} + 9'd1; // u9.0
    wire bit_58 = ~(sum_56 < 9'd250); // u1.0
    wire signed [9:0] difference_59 = {1'd0, sum_56} - 10'd250; // s10.0
    wire [2:0] sum_62 = {1'd0, window_quadrant} + {2'd0, bit_58 ? 1'd1 : 1'd0}; // u3.0
    wire signed [17:0] signed_wave = sign ? (18'd0 - {1'd0, wave}) : {1'd0, wave}; // s18.17
    wire signed [18:0] twice = 19'd130932 - {{1{window[17]}}, window}; // s19.17
    wire signed [19:0] sum_74 = {{1{twice[18]}}, twice} + {19'd0, residue}; // s20.17
    wire [3:0] choice_79 = step_is_sine ? 4'd0 : ({1'd0, step} + 4'd1); // u4.0
    wire step_is_cosine = step == 3'd3; // u1.0

    initial begin : initial_quarter
        quarter[0] = 17'h00000; quarter[1] = 17'h00337; quarter[2] = 17'h0066d; quarter[3] = 17'h009a4;
        quarter[4] = 17'h00cda; quarter[5] = 17'h01011; quarter[6] = 17'h01347; quarter[7] = 17'h0167d;
        quarter[8] = 17'h019b3; quarter[9] = 17'h01ce8; quarter[10] = 17'h0201d; quarter[11] = 17'h02352;
        quarter[12] = 17'h02687; quarter[13] = 17'h029bb; quarter[14] = 17'h02cef; quarter[15] = 17'h03022;
        quarter[16] = 17'h03355; quarter[17] = 17'h03687; quarter[18] = 17'h039b9; quarter[19] = 17'h03cea;
        quarter[20] = 17'h0401a; quarter[21] = 17'h0434a; quarter[22] = 17'h04679; quarter[23] = 17'h049a8;
        quarter[24] = 17'h04cd5; quarter[25] = 17'h05002; quarter[26] = 17'h0532e; quarter[27] = 17'h0565a;
        quarter[28] = 17'h05984; quarter[29] = 17'h05cae; quarter[30] = 17'h05fd6; quarter[31] = 17'h062fe;
        quarter[32] = 17'h06624; quarter[33] = 17'h0694a; quarter[34] = 17'h06c6f; quarter[35] = 17'h06f92;
        quarter[36] = 17'h072b4; quarter[37] = 17'h075d5; quarter[38] = 17'h078f5; quarter[39] = 17'h07c14;
        quarter[40] = 17'h07f31; quarter[41] = 17'h0824e; quarter[42] = 17'h08569; quarter[43] = 17'h08882;
        quarter[44] = 17'h08b9a; quarter[45] = 17'h08eb1; quarter[46] = 17'h091c6; quarter[47] = 17'h094da;
        quarter[48] = 17'h097ec; quarter[49] = 17'h09afd; quarter[50] = 17'h09e0c; quarter[51] = 17'h0a11a;
        quarter[52] = 17'h0a426; quarter[53] = 17'h0a730; quarter[54] = 17'h0aa39; quarter[55] = 17'h0ad40;
        quarter[56] = 17'h0b045; quarter[57] = 17'h0b348; quarter[58] = 17'h0b64a; quarter[59] = 17'h0b949;
        quarter[60] = 17'h0bc47; quarter[61] = 17'h0bf43; quarter[62] = 17'h0c23d; quarter[63] = 17'h0c535;
        quarter[64] = 17'h0c82b; quarter[65] = 17'h0cb1f; quarter[66] = 17'h0ce11; quarter[67] = 17'h0d101;
        quarter[68] = 17'h0d3ef; quarter[69] = 17'h0d6db; quarter[70] = 17'h0d9c4; quarter[71] = 17'h0dcab;
        quarter[72] = 17'h0df90; quarter[73] = 17'h0e273; quarter[74] = 17'h0e554; quarter[75] = 17'h0e832;
        quarter[76] = 17'h0eb0e; quarter[77] = 17'h0ede7; quarter[78] = 17'h0f0be; quarter[79] = 17'h0f393;
        quarter[80] = 17'h0f665; quarter[81] = 17'h0f935; quarter[82] = 17'h0fc02; quarter[83] = 17'h0fecc;
        quarter[84] = 17'h10194; quarter[85] = 17'h1045a; quarter[86] = 17'h1071d; quarter[87] = 17'h109dd;
        quarter[88] = 17'h10c9a; quarter[89] = 17'h10f55; quarter[90] = 17'h1120d; quarter[91] = 17'h114c2;
        quarter[92] = 17'h11775; quarter[93] = 17'h11a24; quarter[94] = 17'h11cd1; quarter[95] = 17'h11f7b;
        quarter[96] = 17'h12222; quarter[97] = 17'h124c6; quarter[98] = 17'h12767; quarter[99] = 17'h12a05;
        quarter[100] = 17'h12ca0; quarter[101] = 17'h12f38; quarter[102] = 17'h131cd; quarter[103] = 17'h1345f;
        quarter[104] = 17'h136ee; quarter[105] = 17'h13979; quarter[106] = 17'h13c02; quarter[107] = 17'h13e87;
        quarter[108] = 17'h14109; quarter[109] = 17'h14388; quarter[110] = 17'h14603; quarter[111] = 17'h1487b;
        quarter[112] = 17'h14af0; quarter[113] = 17'h14d62; quarter[114] = 17'h14fd0; quarter[115] = 17'h1523b;
        quarter[116] = 17'h154a2; quarter[117] = 17'h15706; quarter[118] = 17'h15967; quarter[119] = 17'h15bc4;
        quarter[120] = 17'h15e1d; quarter[121] = 17'h16073; quarter[122] = 17'h162c5; quarter[123] = 17'h16514;
        quarter[124] = 17'h1675f; quarter[125] = 17'h169a7; quarter[126] = 17'h16beb; quarter[127] = 17'h16e2b;
        quarter[128] = 17'h17068; quarter[129] = 17'h172a0; quarter[130] = 17'h174d5; quarter[131] = 17'h17707;
        quarter[132] = 17'h17934; quarter[133] = 17'h17b5e; quarter[134] = 17'h17d84; quarter[135] = 17'h17fa6;
        quarter[136] = 17'h181c4; quarter[137] = 17'h183de; quarter[138] = 17'h185f4; quarter[139] = 17'h18806;
        quarter[140] = 17'h18a15; quarter[141] = 17'h18c1f; quarter[142] = 17'h18e26; quarter[143] = 17'h19028;
        quarter[144] = 17'h19226; quarter[145] = 17'h19421; quarter[146] = 17'h19617; quarter[147] = 17'h19809;
        quarter[148] = 17'h199f7; quarter[149] = 17'h19be1; quarter[150] = 17'h19dc6; quarter[151] = 17'h19fa8;
        quarter[152] = 17'h1a185; quarter[153] = 17'h1a35e; quarter[154] = 17'h1a533; quarter[155] = 17'h1a703;
        quarter[156] = 17'h1a8d0; quarter[157] = 17'h1aa98; quarter[158] = 17'h1ac5b; quarter[159] = 17'h1ae1b;
        quarter[160] = 17'h1afd6; quarter[161] = 17'h1b18c; quarter[162] = 17'h1b33e; quarter[163] = 17'h1b4ec;
        quarter[164] = 17'h1b696; quarter[165] = 17'h1b83b; quarter[166] = 17'h1b9db; quarter[167] = 17'h1bb77;
        quarter[168] = 17'h1bd0f; quarter[169] = 17'h1bea2; quarter[170] = 17'h1c031; quarter[171] = 17'h1c1bb;
        quarter[172] = 17'h1c340; quarter[173] = 17'h1c4c1; quarter[174] = 17'h1c63d; quarter[175] = 17'h1c7b5;
        quarter[176] = 17'h1c928; quarter[177] = 17'h1ca97; quarter[178] = 17'h1cc01; quarter[179] = 17'h1cd66;
        quarter[180] = 17'h1cec7; quarter[181] = 17'h1d023; quarter[182] = 17'h1d17a; quarter[183] = 17'h1d2cd;
        quarter[184] = 17'h1d41a; quarter[185] = 17'h1d563; quarter[186] = 17'h1d6a8; quarter[187] = 17'h1d7e7;
        quarter[188] = 17'h1d922; quarter[189] = 17'h1da58; quarter[190] = 17'h1db89; quarter[191] = 17'h1dcb6;
        quarter[192] = 17'h1ddde; quarter[193] = 17'h1df00; quarter[194] = 17'h1e01e; quarter[195] = 17'h1e137;
        quarter[196] = 17'h1e24c; quarter[197] = 17'h1e35b; quarter[198] = 17'h1e465; quarter[199] = 17'h1e56b;
        quarter[200] = 17'h1e66c; quarter[201] = 17'h1e767; quarter[202] = 17'h1e85e; quarter[203] = 17'h1e950;
        quarter[204] = 17'h1ea3d; quarter[205] = 17'h1eb25; quarter[206] = 17'h1ec08; quarter[207] = 17'h1ece6;
        quarter[208] = 17'h1edbf; quarter[209] = 17'h1ee93; quarter[210] = 17'h1ef63; quarter[211] = 17'h1f02d;
        quarter[212] = 17'h1f0f2; quarter[213] = 17'h1f1b2; quarter[214] = 17'h1f26d; quarter[215] = 17'h1f323;
        quarter[216] = 17'h1f3d4; quarter[217] = 17'h1f480; quarter[218] = 17'h1f526; quarter[219] = 17'h1f5c8;
        quarter[220] = 17'h1f665; quarter[221] = 17'h1f6fc; quarter[222] = 17'h1f78f; quarter[223] = 17'h1f81c;
        quarter[224] = 17'h1f8a5; quarter[225] = 17'h1f928; quarter[226] = 17'h1f9a6; quarter[227] = 17'h1fa1f;
        quarter[228] = 17'h1fa93; quarter[229] = 17'h1fb02; quarter[230] = 17'h1fb6c; quarter[231] = 17'h1fbd0;
        quarter[232] = 17'h1fc30; quarter[233] = 17'h1fc8a; quarter[234] = 17'h1fcdf; quarter[235] = 17'h1fd2f;
        quarter[236] = 17'h1fd7a; quarter[237] = 17'h1fdbf; quarter[238] = 17'h1fe00; quarter[239] = 17'h1fe3b;
        quarter[240] = 17'h1fe72; quarter[241] = 17'h1fea3; quarter[242] = 17'h1fecf; quarter[243] = 17'h1fef5;
        quarter[244] = 17'h1ff17; quarter[245] = 17'h1ff33; quarter[246] = 17'h1ff4b; quarter[247] = 17'h1ff5d;
        quarter[248] = 17'h1ff6a; quarter[249] = 17'h1ff71; quarter[250] = 17'h1ff74;
    end

    always @(posedge clock) begin
        quarter_word <= quarter[choice_32[0] ? difference_36[7:0] : choice_34];
    end

    always @(posedge clock) begin
        if (reset) begin
            step <= 3'd0;
            quadrant <= 2'd0;
            phase_q <= 8'd0;
            window_quadrant <= 2'd0;
            window_phase <= 8'd0;
            negative <= 1'd0;
            wave <= 17'd0;
            sign <= 1'd0;
            cosine <= 18'd0;
            sine <= 18'd0;
            window <= 18'd0;
            residue <= 1'd0;
            ready <= 1'd0;
        end else begin
            if (sample) begin
                step <= 3'd1;
                negative <= choice_32[1];
                ready <= 1'd0;
                if (restart) begin
                    quadrant <= 2'd0;
                    phase_q <= 8'd0;
                end
                if (first) begin
                    window_quadrant <= 2'd0;
                    window_phase <= 8'd0;
                    residue <= 1'd0;
                end
            end else if (bit_18) begin
                step <= choice_79[2:0];
                negative <= choice_32[1];
                wave <= quarter_word;
                sign <= negative;
                window <= step_is_wave ? signed_wave : step_is_cosine ? sum_74[18:1] : window;
                ready <= step_is_cosine;
                if (step_is_cosine) begin
                    residue <= sum_74[0];
                end
                if (step_is_cosine | step_is_sine) begin
                    sine <= signed_wave;
                end
                if (step_is_sine) begin
                    quadrant <= sum_50[1:0];
                    phase_q <= bit_46 ? difference_47[7:0] : sum_44[7:0];
                    window_quadrant <= sum_62[1:0];
                    window_phase <= bit_58 ? difference_59[7:0] : sum_56[7:0];
                    cosine <= sine;
                end
            end else begin
                ready <= 1'd0;
            end
        end
    end

    assign phase = 1'd0;

    // What nothing needs.
    wire unused = &{1'b0, sum_30[2], difference_36[8], difference_47[9:8], sum_50[2], difference_59[9:8], sum_62[2],
        sum_74[19], choice_79[3]};

endmodule

`default_nettype wire

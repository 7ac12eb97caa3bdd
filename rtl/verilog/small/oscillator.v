// oscillator: hapticore_model::blocks::oscillator::Oscillator
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module oscillator (
    input wire clock,
    input wire reset,
    input wire sample, // u1.0  A sample is there.
    input wire restart, // u1.0  It is the first of its slot.
    input wire first, // u1.0  It is the first of its window.
    output reg ready, // u1.0  Set for one clock before the other outputs are those of the sample.
    output reg signed [15:0] cosine, // s16.15  The cosine of the carrier.
    output reg signed [15:0] sine, // s16.15  The sine of the carrier.
    output reg signed [15:0] window // s16.15  The window.
);

    reg [2:0] step; // u3.0  0 idle, 1 look_up, 2 wave, 3 cosine, 4 sine
    reg [31:0] phase; // u32.32
    reg [31:0] window_phase; // u32.32
    reg negative; // u1.0
    reg [14:0] wave; // u15.15
    reg sign; // u1.0
    reg [14:0] quarter [0:255]; // 256 words u15.15
    reg [14:0] quarter_word; // its read register

    wire bit_16 = ~(step == 3'd0); // u1.0
    wire step_is_wave = step == 3'd2; // u1.0
    wire [32:0] sum_31 = {1'd0, ((step == 3'd1) | step_is_wave) ? phase : (sample & first) ? 32'd0 : window_phase} + {1'd0, step_is_wave ? 32'd0 : 32'd1073741824}; // u33.32
    wire [31:0] angle = sum_31[31:0]; // u32.32
    wire signed [8:0] difference_35 = 9'd255 - {1'd0, angle[29:22]}; // s9.0
    wire signed [15:0] signed_wave = sign ? (16'd0 - {1'd0, wave}) : {1'd0, wave}; // s16.15
    wire step_is_sine = step == 3'd4; // u1.0
    wire [3:0] choice_48 = step_is_sine ? 4'd0 : ({1'd0, step} + 4'd1); // u4.0
    wire [32:0] sum_51 = {1'd0, phase} + 33'd858993459; // u33.32
    wire [32:0] sum_55 = {1'd0, window_phase} + 33'd8589935; // u33.32
    wire step_is_cosine = step == 3'd3; // u1.0
    wire signed [17:0] difference_60 = 18'd32768 - {{2{window[15]}}, window}; // s18.15
    wire signed [17:0] rounded = {difference_60[17], difference_60[17:1]} + {17'd0, difference_60[0] & difference_60[1]};

    initial begin : initial_quarter
        quarter[0] = 15'h0065; quarter[1] = 15'h012e; quarter[2] = 15'h01f7; quarter[3] = 15'h02c0;
        quarter[4] = 15'h0389; quarter[5] = 15'h0452; quarter[6] = 15'h051b; quarter[7] = 15'h05e3;
        quarter[8] = 15'h06ac; quarter[9] = 15'h0775; quarter[10] = 15'h083e; quarter[11] = 15'h0906;
        quarter[12] = 15'h09cf; quarter[13] = 15'h0a97; quarter[14] = 15'h0b5f; quarter[15] = 15'h0c28;
        quarter[16] = 15'h0cf0; quarter[17] = 15'h0db8; quarter[18] = 15'h0e80; quarter[19] = 15'h0f47;
        quarter[20] = 15'h100f; quarter[21] = 15'h10d6; quarter[22] = 15'h119d; quarter[23] = 15'h1264;
        quarter[24] = 15'h132b; quarter[25] = 15'h13f2; quarter[26] = 15'h14b9; quarter[27] = 15'h157f;
        quarter[28] = 15'h1645; quarter[29] = 15'h170b; quarter[30] = 15'h17d0; quarter[31] = 15'h1896;
        quarter[32] = 15'h195b; quarter[33] = 15'h1a20; quarter[34] = 15'h1ae5; quarter[35] = 15'h1ba9;
        quarter[36] = 15'h1c6d; quarter[37] = 15'h1d31; quarter[38] = 15'h1df5; quarter[39] = 15'h1eb8;
        quarter[40] = 15'h1f7b; quarter[41] = 15'h203e; quarter[42] = 15'h2100; quarter[43] = 15'h21c2;
        quarter[44] = 15'h2284; quarter[45] = 15'h2346; quarter[46] = 15'h2407; quarter[47] = 15'h24c8;
        quarter[48] = 15'h2588; quarter[49] = 15'h2648; quarter[50] = 15'h2708; quarter[51] = 15'h27c7;
        quarter[52] = 15'h2886; quarter[53] = 15'h2944; quarter[54] = 15'h2a02; quarter[55] = 15'h2ac0;
        quarter[56] = 15'h2b7d; quarter[57] = 15'h2c3a; quarter[58] = 15'h2cf7; quarter[59] = 15'h2db3;
        quarter[60] = 15'h2e6e; quarter[61] = 15'h2f2a; quarter[62] = 15'h2fe4; quarter[63] = 15'h309e;
        quarter[64] = 15'h3158; quarter[65] = 15'h3211; quarter[66] = 15'h32ca; quarter[67] = 15'h3383;
        quarter[68] = 15'h343a; quarter[69] = 15'h34f2; quarter[70] = 15'h35a8; quarter[71] = 15'h365f;
        quarter[72] = 15'h3715; quarter[73] = 15'h37ca; quarter[74] = 15'h387e; quarter[75] = 15'h3933;
        quarter[76] = 15'h39e6; quarter[77] = 15'h3a99; quarter[78] = 15'h3b4c; quarter[79] = 15'h3bfe;
        quarter[80] = 15'h3caf; quarter[81] = 15'h3d60; quarter[82] = 15'h3e10; quarter[83] = 15'h3ebf;
        quarter[84] = 15'h3f6e; quarter[85] = 15'h401d; quarter[86] = 15'h40ca; quarter[87] = 15'h4177;
        quarter[88] = 15'h4224; quarter[89] = 15'h42d0; quarter[90] = 15'h437b; quarter[91] = 15'h4425;
        quarter[92] = 15'h44cf; quarter[93] = 15'h4578; quarter[94] = 15'h4621; quarter[95] = 15'h46c9;
        quarter[96] = 15'h4770; quarter[97] = 15'h4816; quarter[98] = 15'h48bc; quarter[99] = 15'h4961;
        quarter[100] = 15'h4a06; quarter[101] = 15'h4aa9; quarter[102] = 15'h4b4c; quarter[103] = 15'h4bee;
        quarter[104] = 15'h4c90; quarter[105] = 15'h4d31; quarter[106] = 15'h4dd1; quarter[107] = 15'h4e70;
        quarter[108] = 15'h4f0e; quarter[109] = 15'h4fac; quarter[110] = 15'h5049; quarter[111] = 15'h50e5;
        quarter[112] = 15'h5181; quarter[113] = 15'h521b; quarter[114] = 15'h52b5; quarter[115] = 15'h534e;
        quarter[116] = 15'h53e7; quarter[117] = 15'h547e; quarter[118] = 15'h5515; quarter[119] = 15'h55aa;
        quarter[120] = 15'h563f; quarter[121] = 15'h56d3; quarter[122] = 15'h5767; quarter[123] = 15'h57f9;
        quarter[124] = 15'h588b; quarter[125] = 15'h591c; quarter[126] = 15'h59ac; quarter[127] = 15'h5a3b;
        quarter[128] = 15'h5ac9; quarter[129] = 15'h5b56; quarter[130] = 15'h5be2; quarter[131] = 15'h5c6e;
        quarter[132] = 15'h5cf9; quarter[133] = 15'h5d82; quarter[134] = 15'h5e0b; quarter[135] = 15'h5e93;
        quarter[136] = 15'h5f1a; quarter[137] = 15'h5fa0; quarter[138] = 15'h6025; quarter[139] = 15'h60aa;
        quarter[140] = 15'h612d; quarter[141] = 15'h61af; quarter[142] = 15'h6231; quarter[143] = 15'h62b1;
        quarter[144] = 15'h6331; quarter[145] = 15'h63af; quarter[146] = 15'h642d; quarter[147] = 15'h64aa;
        quarter[148] = 15'h6525; quarter[149] = 15'h65a0; quarter[150] = 15'h661a; quarter[151] = 15'h6693;
        quarter[152] = 15'h670a; quarter[153] = 15'h6781; quarter[154] = 15'h67f7; quarter[155] = 15'h686c;
        quarter[156] = 15'h68e0; quarter[157] = 15'h6952; quarter[158] = 15'h69c4; quarter[159] = 15'h6a35;
        quarter[160] = 15'h6aa4; quarter[161] = 15'h6b13; quarter[162] = 15'h6b81; quarter[163] = 15'h6bed;
        quarter[164] = 15'h6c59; quarter[165] = 15'h6cc3; quarter[166] = 15'h6d2d; quarter[167] = 15'h6d95;
        quarter[168] = 15'h6dfd; quarter[169] = 15'h6e63; quarter[170] = 15'h6ec8; quarter[171] = 15'h6f2c;
        quarter[172] = 15'h6f90; quarter[173] = 15'h6ff2; quarter[174] = 15'h7053; quarter[175] = 15'h70b2;
        quarter[176] = 15'h7111; quarter[177] = 15'h716f; quarter[178] = 15'h71cb; quarter[179] = 15'h7227;
        quarter[180] = 15'h7281; quarter[181] = 15'h72db; quarter[182] = 15'h7333; quarter[183] = 15'h738a;
        quarter[184] = 15'h73e0; quarter[185] = 15'h7435; quarter[186] = 15'h7488; quarter[187] = 15'h74db;
        quarter[188] = 15'h752d; quarter[189] = 15'h757d; quarter[190] = 15'h75cc; quarter[191] = 15'h761a;
        quarter[192] = 15'h7667; quarter[193] = 15'h76b3; quarter[194] = 15'h76fe; quarter[195] = 15'h7747;
        quarter[196] = 15'h778f; quarter[197] = 15'h77d7; quarter[198] = 15'h781d; quarter[199] = 15'h7862;
        quarter[200] = 15'h78a5; quarter[201] = 15'h78e8; quarter[202] = 15'h7929; quarter[203] = 15'h796a;
        quarter[204] = 15'h79a9; quarter[205] = 15'h79e6; quarter[206] = 15'h7a23; quarter[207] = 15'h7a5f;
        quarter[208] = 15'h7a99; quarter[209] = 15'h7ad2; quarter[210] = 15'h7b0a; quarter[211] = 15'h7b41;
        quarter[212] = 15'h7b77; quarter[213] = 15'h7bab; quarter[214] = 15'h7bde; quarter[215] = 15'h7c10;
        quarter[216] = 15'h7c41; quarter[217] = 15'h7c71; quarter[218] = 15'h7c9f; quarter[219] = 15'h7ccd;
        quarter[220] = 15'h7cf9; quarter[221] = 15'h7d24; quarter[222] = 15'h7d4d; quarter[223] = 15'h7d76;
        quarter[224] = 15'h7d9d; quarter[225] = 15'h7dc3; quarter[226] = 15'h7de8; quarter[227] = 15'h7e0b;
        quarter[228] = 15'h7e2e; quarter[229] = 15'h7e4f; quarter[230] = 15'h7e6f; quarter[231] = 15'h7e8d;
        quarter[232] = 15'h7eab; quarter[233] = 15'h7ec7; quarter[234] = 15'h7ee2; quarter[235] = 15'h7efc;
        quarter[236] = 15'h7f15; quarter[237] = 15'h7f2c; quarter[238] = 15'h7f42; quarter[239] = 15'h7f57;
        quarter[240] = 15'h7f6b; quarter[241] = 15'h7f7d; quarter[242] = 15'h7f8f; quarter[243] = 15'h7f9f;
        quarter[244] = 15'h7fad; quarter[245] = 15'h7fbb; quarter[246] = 15'h7fc7; quarter[247] = 15'h7fd2;
        quarter[248] = 15'h7fdc; quarter[249] = 15'h7fe5; quarter[250] = 15'h7fec; quarter[251] = 15'h7ff3;
        quarter[252] = 15'h7ff7; quarter[253] = 15'h7ffb; quarter[254] = 15'h7ffe; quarter[255] = 15'h7fff;
    end

    always @(posedge clock) begin
        quarter_word <= quarter[angle[30] ? difference_35[7:0] : angle[29:22]];
    end

    always @(posedge clock) begin
        if (reset) begin
            step <= 3'd0;
            phase <= 32'd0;
            window_phase <= 32'd0;
            negative <= 1'd0;
            wave <= 15'd0;
            sign <= 1'd0;
            cosine <= 16'd0;
            sine <= 16'd0;
            window <= 16'd0;
            ready <= 1'd0;
        end else begin
            if (sample) begin
                step <= 3'd1;
                negative <= angle[31];
                ready <= 1'd0;
                if (first) begin
                    window_phase <= 32'd0;
                end
                if (restart) begin
                    phase <= 32'd0;
                end
            end else if (bit_16) begin
                step <= choice_48[2:0];
                negative <= angle[31];
                wave <= quarter_word;
                sign <= negative;
                window <=
                    step_is_wave ? signed_wave
                    : step_is_cosine ? ((rounded[17:15] == {3{rounded[17]}}) ? rounded[15:0] : {rounded[17], {15{~rounded[17]}}})
                    : window;
                ready <= step_is_cosine;
                if (step_is_cosine | step_is_sine) begin
                    sine <= signed_wave;
                end
                if (step_is_sine) begin
                    phase <= sum_51[31:0];
                    window_phase <= sum_55[31:0];
                    cosine <= sine;
                end
            end else begin
                ready <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_31[32], angle[21:0], difference_35[8], choice_48[3], sum_51[32], sum_55[32]};

endmodule

`default_nettype wire

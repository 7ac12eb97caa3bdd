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
    output reg signed [17:0] window // s18.17  The window.
);

    reg [2:0] step; // u3.0  0 idle, 1 look_up, 2 wave, 3 cosine, 4 sine
    reg [31:0] phase; // u32.32
    reg [31:0] window_phase; // u32.32
    reg negative; // u1.0
    reg [16:0] wave; // u17.17
    reg sign; // u1.0
    reg [16:0] quarter [0:1023]; // 1024 words u17.17
    reg [16:0] quarter_word; // its read register

    wire bit_16 = ~(step == 3'd0); // u1.0
    wire step_is_wave = step == 3'd2; // u1.0
    wire [32:0] sum_31 = {1'd0, ((step == 3'd1) | step_is_wave) ? phase : (sample & first) ? 32'd0 : window_phase} + {1'd0, step_is_wave ? 32'd0 : 32'd1073741824}; // u33.32
    wire [31:0] angle = sum_31[31:0]; // u32.32
    wire signed [10:0] difference_35 = 11'd1023 - {1'd0, angle[29:20]}; // s11.0
    wire signed [17:0] signed_wave = sign ? (18'd0 - {1'd0, wave}) : {1'd0, wave}; // s18.17
    wire step_is_sine = step == 3'd4; // u1.0
    wire [3:0] choice_48 = step_is_sine ? 4'd0 : ({1'd0, step} + 4'd1); // u4.0
    wire [32:0] sum_51 = {1'd0, phase} + 33'd429496730; // u33.32
    wire [32:0] sum_55 = {1'd0, window_phase} + 33'd4294967; // u33.32
    wire step_is_cosine = step == 3'd3; // u1.0
    wire signed [19:0] difference_60 = 20'd131072 - {{2{window[17]}}, window}; // s20.17
    wire signed [19:0] rounded = {difference_60[19], difference_60[19:1]} + {19'd0, difference_60[0] & difference_60[1]};

    initial begin : initial_quarter
        quarter[0] = 17'h00065; quarter[1] = 17'h0012e; quarter[2] = 17'h001f7; quarter[3] = 17'h002c0;
        quarter[4] = 17'h00389; quarter[5] = 17'h00452; quarter[6] = 17'h0051b; quarter[7] = 17'h005e4;
        quarter[8] = 17'h006ad; quarter[9] = 17'h00776; quarter[10] = 17'h0083f; quarter[11] = 17'h00908;
        quarter[12] = 17'h009d1; quarter[13] = 17'h00a9a; quarter[14] = 17'h00b63; quarter[15] = 17'h00c2c;
        quarter[16] = 17'h00cf5; quarter[17] = 17'h00dbe; quarter[18] = 17'h00e87; quarter[19] = 17'h00f50;
        quarter[20] = 17'h01019; quarter[21] = 17'h010e2; quarter[22] = 17'h011ab; quarter[23] = 17'h01274;
        quarter[24] = 17'h0133d; quarter[25] = 17'h01406; quarter[26] = 17'h014cf; quarter[27] = 17'h01598;
        quarter[28] = 17'h01660; quarter[29] = 17'h01729; quarter[30] = 17'h017f2; quarter[31] = 17'h018bb;
        quarter[32] = 17'h01984; quarter[33] = 17'h01a4d; quarter[34] = 17'h01b15; quarter[35] = 17'h01bde;
        quarter[36] = 17'h01ca7; quarter[37] = 17'h01d70; quarter[38] = 17'h01e38; quarter[39] = 17'h01f01;
        quarter[40] = 17'h01fca; quarter[41] = 17'h02092; quarter[42] = 17'h0215b; quarter[43] = 17'h02224;
        quarter[44] = 17'h022ec; quarter[45] = 17'h023b5; quarter[46] = 17'h0247d; quarter[47] = 17'h02546;
        quarter[48] = 17'h0260e; quarter[49] = 17'h026d7; quarter[50] = 17'h0279f; quarter[51] = 17'h02868;
        quarter[52] = 17'h02930; quarter[53] = 17'h029f9; quarter[54] = 17'h02ac1; quarter[55] = 17'h02b89;
        quarter[56] = 17'h02c52; quarter[57] = 17'h02d1a; quarter[58] = 17'h02de2; quarter[59] = 17'h02eaa;
        quarter[60] = 17'h02f73; quarter[61] = 17'h0303b; quarter[62] = 17'h03103; quarter[63] = 17'h031cb;
        quarter[64] = 17'h03293; quarter[65] = 17'h0335b; quarter[66] = 17'h03423; quarter[67] = 17'h034eb;
        quarter[68] = 17'h035b3; quarter[69] = 17'h0367b; quarter[70] = 17'h03743; quarter[71] = 17'h0380b;
        quarter[72] = 17'h038d3; quarter[73] = 17'h0399b; quarter[74] = 17'h03a62; quarter[75] = 17'h03b2a;
        quarter[76] = 17'h03bf2; quarter[77] = 17'h03cba; quarter[78] = 17'h03d81; quarter[79] = 17'h03e49;
        quarter[80] = 17'h03f10; quarter[81] = 17'h03fd8; quarter[82] = 17'h0409f; quarter[83] = 17'h04167;
        quarter[84] = 17'h0422e; quarter[85] = 17'h042f5; quarter[86] = 17'h043bd; quarter[87] = 17'h04484;
        quarter[88] = 17'h0454b; quarter[89] = 17'h04612; quarter[90] = 17'h046da; quarter[91] = 17'h047a1;
        quarter[92] = 17'h04868; quarter[93] = 17'h0492f; quarter[94] = 17'h049f6; quarter[95] = 17'h04abd;
        quarter[96] = 17'h04b84; quarter[97] = 17'h04c4a; quarter[98] = 17'h04d11; quarter[99] = 17'h04dd8;
        quarter[100] = 17'h04e9f; quarter[101] = 17'h04f65; quarter[102] = 17'h0502c; quarter[103] = 17'h050f2;
        quarter[104] = 17'h051b9; quarter[105] = 17'h0527f; quarter[106] = 17'h05346; quarter[107] = 17'h0540c;
        quarter[108] = 17'h054d2; quarter[109] = 17'h05599; quarter[110] = 17'h0565f; quarter[111] = 17'h05725;
        quarter[112] = 17'h057eb; quarter[113] = 17'h058b1; quarter[114] = 17'h05977; quarter[115] = 17'h05a3d;
        quarter[116] = 17'h05b03; quarter[117] = 17'h05bc9; quarter[118] = 17'h05c8f; quarter[119] = 17'h05d54;
        quarter[120] = 17'h05e1a; quarter[121] = 17'h05ee0; quarter[122] = 17'h05fa5; quarter[123] = 17'h0606b;
        quarter[124] = 17'h06130; quarter[125] = 17'h061f6; quarter[126] = 17'h062bb; quarter[127] = 17'h06380;
        quarter[128] = 17'h06445; quarter[129] = 17'h0650a; quarter[130] = 17'h065cf; quarter[131] = 17'h06695;
        quarter[132] = 17'h06759; quarter[133] = 17'h0681e; quarter[134] = 17'h068e3; quarter[135] = 17'h069a8;
        quarter[136] = 17'h06a6d; quarter[137] = 17'h06b31; quarter[138] = 17'h06bf6; quarter[139] = 17'h06cba;
        quarter[140] = 17'h06d7f; quarter[141] = 17'h06e43; quarter[142] = 17'h06f07; quarter[143] = 17'h06fcc;
        quarter[144] = 17'h07090; quarter[145] = 17'h07154; quarter[146] = 17'h07218; quarter[147] = 17'h072dc;
        quarter[148] = 17'h073a0; quarter[149] = 17'h07464; quarter[150] = 17'h07528; quarter[151] = 17'h075eb;
        quarter[152] = 17'h076af; quarter[153] = 17'h07772; quarter[154] = 17'h07836; quarter[155] = 17'h078f9;
        quarter[156] = 17'h079bd; quarter[157] = 17'h07a80; quarter[158] = 17'h07b43; quarter[159] = 17'h07c06;
        quarter[160] = 17'h07cc9; quarter[161] = 17'h07d8c; quarter[162] = 17'h07e4f; quarter[163] = 17'h07f12;
        quarter[164] = 17'h07fd5; quarter[165] = 17'h08097; quarter[166] = 17'h0815a; quarter[167] = 17'h0821c;
        quarter[168] = 17'h082df; quarter[169] = 17'h083a1; quarter[170] = 17'h08463; quarter[171] = 17'h08525;
        quarter[172] = 17'h085e8; quarter[173] = 17'h086aa; quarter[174] = 17'h0876c; quarter[175] = 17'h0882d;
        quarter[176] = 17'h088ef; quarter[177] = 17'h089b1; quarter[178] = 17'h08a72; quarter[179] = 17'h08b34;
        quarter[180] = 17'h08bf5; quarter[181] = 17'h08cb7; quarter[182] = 17'h08d78; quarter[183] = 17'h08e39;
        quarter[184] = 17'h08efa; quarter[185] = 17'h08fbb; quarter[186] = 17'h0907c; quarter[187] = 17'h0913d;
        quarter[188] = 17'h091fe; quarter[189] = 17'h092bf; quarter[190] = 17'h0937f; quarter[191] = 17'h09440;
        quarter[192] = 17'h09500; quarter[193] = 17'h095c0; quarter[194] = 17'h09681; quarter[195] = 17'h09741;
        quarter[196] = 17'h09801; quarter[197] = 17'h098c1; quarter[198] = 17'h09981; quarter[199] = 17'h09a40;
        quarter[200] = 17'h09b00; quarter[201] = 17'h09bc0; quarter[202] = 17'h09c7f; quarter[203] = 17'h09d3f;
        quarter[204] = 17'h09dfe; quarter[205] = 17'h09ebd; quarter[206] = 17'h09f7c; quarter[207] = 17'h0a03b;
        quarter[208] = 17'h0a0fa; quarter[209] = 17'h0a1b9; quarter[210] = 17'h0a278; quarter[211] = 17'h0a336;
        quarter[212] = 17'h0a3f5; quarter[213] = 17'h0a4b3; quarter[214] = 17'h0a571; quarter[215] = 17'h0a630;
        quarter[216] = 17'h0a6ee; quarter[217] = 17'h0a7ac; quarter[218] = 17'h0a86a; quarter[219] = 17'h0a928;
        quarter[220] = 17'h0a9e5; quarter[221] = 17'h0aaa3; quarter[222] = 17'h0ab60; quarter[223] = 17'h0ac1e;
        quarter[224] = 17'h0acdb; quarter[225] = 17'h0ad98; quarter[226] = 17'h0ae55; quarter[227] = 17'h0af12;
        quarter[228] = 17'h0afcf; quarter[229] = 17'h0b08c; quarter[230] = 17'h0b149; quarter[231] = 17'h0b205;
        quarter[232] = 17'h0b2c2; quarter[233] = 17'h0b37e; quarter[234] = 17'h0b43a; quarter[235] = 17'h0b4f7;
        quarter[236] = 17'h0b5b3; quarter[237] = 17'h0b66e; quarter[238] = 17'h0b72a; quarter[239] = 17'h0b7e6;
        quarter[240] = 17'h0b8a2; quarter[241] = 17'h0b95d; quarter[242] = 17'h0ba18; quarter[243] = 17'h0bad4;
        quarter[244] = 17'h0bb8f; quarter[245] = 17'h0bc4a; quarter[246] = 17'h0bd05; quarter[247] = 17'h0bdc0;
        quarter[248] = 17'h0be7a; quarter[249] = 17'h0bf35; quarter[250] = 17'h0bfef; quarter[251] = 17'h0c0aa;
        quarter[252] = 17'h0c164; quarter[253] = 17'h0c21e; quarter[254] = 17'h0c2d8; quarter[255] = 17'h0c392;
        quarter[256] = 17'h0c44c; quarter[257] = 17'h0c505; quarter[258] = 17'h0c5bf; quarter[259] = 17'h0c678;
        quarter[260] = 17'h0c731; quarter[261] = 17'h0c7eb; quarter[262] = 17'h0c8a4; quarter[263] = 17'h0c95d;
        quarter[264] = 17'h0ca15; quarter[265] = 17'h0cace; quarter[266] = 17'h0cb87; quarter[267] = 17'h0cc3f;
        quarter[268] = 17'h0ccf7; quarter[269] = 17'h0cdaf; quarter[270] = 17'h0ce68; quarter[271] = 17'h0cf1f;
        quarter[272] = 17'h0cfd7; quarter[273] = 17'h0d08f; quarter[274] = 17'h0d147; quarter[275] = 17'h0d1fe;
        quarter[276] = 17'h0d2b5; quarter[277] = 17'h0d36c; quarter[278] = 17'h0d423; quarter[279] = 17'h0d4da;
        quarter[280] = 17'h0d591; quarter[281] = 17'h0d648; quarter[282] = 17'h0d6fe; quarter[283] = 17'h0d7b5;
        quarter[284] = 17'h0d86b; quarter[285] = 17'h0d921; quarter[286] = 17'h0d9d7; quarter[287] = 17'h0da8d;
        quarter[288] = 17'h0db43; quarter[289] = 17'h0dbf9; quarter[290] = 17'h0dcae; quarter[291] = 17'h0dd63;
        quarter[292] = 17'h0de19; quarter[293] = 17'h0dece; quarter[294] = 17'h0df83; quarter[295] = 17'h0e038;
        quarter[296] = 17'h0e0ec; quarter[297] = 17'h0e1a1; quarter[298] = 17'h0e255; quarter[299] = 17'h0e309;
        quarter[300] = 17'h0e3be; quarter[301] = 17'h0e472; quarter[302] = 17'h0e525; quarter[303] = 17'h0e5d9;
        quarter[304] = 17'h0e68d; quarter[305] = 17'h0e740; quarter[306] = 17'h0e7f4; quarter[307] = 17'h0e8a7;
        quarter[308] = 17'h0e95a; quarter[309] = 17'h0ea0d; quarter[310] = 17'h0eabf; quarter[311] = 17'h0eb72;
        quarter[312] = 17'h0ec24; quarter[313] = 17'h0ecd7; quarter[314] = 17'h0ed89; quarter[315] = 17'h0ee3b;
        quarter[316] = 17'h0eeed; quarter[317] = 17'h0ef9f; quarter[318] = 17'h0f050; quarter[319] = 17'h0f102;
        quarter[320] = 17'h0f1b3; quarter[321] = 17'h0f264; quarter[322] = 17'h0f315; quarter[323] = 17'h0f3c6;
        quarter[324] = 17'h0f477; quarter[325] = 17'h0f527; quarter[326] = 17'h0f5d8; quarter[327] = 17'h0f688;
        quarter[328] = 17'h0f738; quarter[329] = 17'h0f7e8; quarter[330] = 17'h0f898; quarter[331] = 17'h0f948;
        quarter[332] = 17'h0f9f7; quarter[333] = 17'h0faa7; quarter[334] = 17'h0fb56; quarter[335] = 17'h0fc05;
        quarter[336] = 17'h0fcb4; quarter[337] = 17'h0fd63; quarter[338] = 17'h0fe12; quarter[339] = 17'h0fec0;
        quarter[340] = 17'h0ff6e; quarter[341] = 17'h1001d; quarter[342] = 17'h100cb; quarter[343] = 17'h10178;
        quarter[344] = 17'h10226; quarter[345] = 17'h102d4; quarter[346] = 17'h10381; quarter[347] = 17'h1042e;
        quarter[348] = 17'h104db; quarter[349] = 17'h10588; quarter[350] = 17'h10635; quarter[351] = 17'h106e2;
        quarter[352] = 17'h1078e; quarter[353] = 17'h1083a; quarter[354] = 17'h108e7; quarter[355] = 17'h10993;
        quarter[356] = 17'h10a3e; quarter[357] = 17'h10aea; quarter[358] = 17'h10b96; quarter[359] = 17'h10c41;
        quarter[360] = 17'h10cec; quarter[361] = 17'h10d97; quarter[362] = 17'h10e42; quarter[363] = 17'h10eed;
        quarter[364] = 17'h10f97; quarter[365] = 17'h11041; quarter[366] = 17'h110ec; quarter[367] = 17'h11196;
        quarter[368] = 17'h11240; quarter[369] = 17'h112e9; quarter[370] = 17'h11393; quarter[371] = 17'h1143c;
        quarter[372] = 17'h114e5; quarter[373] = 17'h1158e; quarter[374] = 17'h11637; quarter[375] = 17'h116e0;
        quarter[376] = 17'h11789; quarter[377] = 17'h11831; quarter[378] = 17'h118d9; quarter[379] = 17'h11981;
        quarter[380] = 17'h11a29; quarter[381] = 17'h11ad1; quarter[382] = 17'h11b78; quarter[383] = 17'h11c20;
        quarter[384] = 17'h11cc7; quarter[385] = 17'h11d6e; quarter[386] = 17'h11e15; quarter[387] = 17'h11ebb;
        quarter[388] = 17'h11f62; quarter[389] = 17'h12008; quarter[390] = 17'h120ae; quarter[391] = 17'h12154;
        quarter[392] = 17'h121fa; quarter[393] = 17'h122a0; quarter[394] = 17'h12345; quarter[395] = 17'h123ea;
        quarter[396] = 17'h1248f; quarter[397] = 17'h12534; quarter[398] = 17'h125d9; quarter[399] = 17'h1267e;
        quarter[400] = 17'h12722; quarter[401] = 17'h127c6; quarter[402] = 17'h1286a; quarter[403] = 17'h1290e;
        quarter[404] = 17'h129b2; quarter[405] = 17'h12a55; quarter[406] = 17'h12af8; quarter[407] = 17'h12b9c;
        quarter[408] = 17'h12c3f; quarter[409] = 17'h12ce1; quarter[410] = 17'h12d84; quarter[411] = 17'h12e26;
        quarter[412] = 17'h12ec9; quarter[413] = 17'h12f6b; quarter[414] = 17'h1300c; quarter[415] = 17'h130ae;
        quarter[416] = 17'h13150; quarter[417] = 17'h131f1; quarter[418] = 17'h13292; quarter[419] = 17'h13333;
        quarter[420] = 17'h133d4; quarter[421] = 17'h13474; quarter[422] = 17'h13515; quarter[423] = 17'h135b5;
        quarter[424] = 17'h13655; quarter[425] = 17'h136f5; quarter[426] = 17'h13794; quarter[427] = 17'h13834;
        quarter[428] = 17'h138d3; quarter[429] = 17'h13972; quarter[430] = 17'h13a11; quarter[431] = 17'h13ab0;
        quarter[432] = 17'h13b4e; quarter[433] = 17'h13bed; quarter[434] = 17'h13c8b; quarter[435] = 17'h13d29;
        quarter[436] = 17'h13dc6; quarter[437] = 17'h13e64; quarter[438] = 17'h13f01; quarter[439] = 17'h13f9e;
        quarter[440] = 17'h1403b; quarter[441] = 17'h140d8; quarter[442] = 17'h14175; quarter[443] = 17'h14211;
        quarter[444] = 17'h142ad; quarter[445] = 17'h14349; quarter[446] = 17'h143e5; quarter[447] = 17'h14481;
        quarter[448] = 17'h1451c; quarter[449] = 17'h145b7; quarter[450] = 17'h14653; quarter[451] = 17'h146ed;
        quarter[452] = 17'h14788; quarter[453] = 17'h14822; quarter[454] = 17'h148bd; quarter[455] = 17'h14957;
        quarter[456] = 17'h149f1; quarter[457] = 17'h14a8a; quarter[458] = 17'h14b24; quarter[459] = 17'h14bbd;
        quarter[460] = 17'h14c56; quarter[461] = 17'h14cef; quarter[462] = 17'h14d87; quarter[463] = 17'h14e20;
        quarter[464] = 17'h14eb8; quarter[465] = 17'h14f50; quarter[466] = 17'h14fe8; quarter[467] = 17'h15080;
        quarter[468] = 17'h15117; quarter[469] = 17'h151ae; quarter[470] = 17'h15245; quarter[471] = 17'h152dc;
        quarter[472] = 17'h15373; quarter[473] = 17'h15409; quarter[474] = 17'h1549f; quarter[475] = 17'h15535;
        quarter[476] = 17'h155cb; quarter[477] = 17'h15661; quarter[478] = 17'h156f6; quarter[479] = 17'h1578b;
        quarter[480] = 17'h15820; quarter[481] = 17'h158b5; quarter[482] = 17'h1594a; quarter[483] = 17'h159de;
        quarter[484] = 17'h15a72; quarter[485] = 17'h15b06; quarter[486] = 17'h15b9a; quarter[487] = 17'h15c2d;
        quarter[488] = 17'h15cc1; quarter[489] = 17'h15d54; quarter[490] = 17'h15de7; quarter[491] = 17'h15e79;
        quarter[492] = 17'h15f0c; quarter[493] = 17'h15f9e; quarter[494] = 17'h16030; quarter[495] = 17'h160c2;
        quarter[496] = 17'h16154; quarter[497] = 17'h161e5; quarter[498] = 17'h16276; quarter[499] = 17'h16307;
        quarter[500] = 17'h16398; quarter[501] = 17'h16428; quarter[502] = 17'h164b9; quarter[503] = 17'h16549;
        quarter[504] = 17'h165d9; quarter[505] = 17'h16668; quarter[506] = 17'h166f8; quarter[507] = 17'h16787;
        quarter[508] = 17'h16816; quarter[509] = 17'h168a5; quarter[510] = 17'h16934; quarter[511] = 17'h169c2;
        quarter[512] = 17'h16a50; quarter[513] = 17'h16ade; quarter[514] = 17'h16b6c; quarter[515] = 17'h16bf9;
        quarter[516] = 17'h16c87; quarter[517] = 17'h16d14; quarter[518] = 17'h16da1; quarter[519] = 17'h16e2d;
        quarter[520] = 17'h16eba; quarter[521] = 17'h16f46; quarter[522] = 17'h16fd2; quarter[523] = 17'h1705e;
        quarter[524] = 17'h170e9; quarter[525] = 17'h17174; quarter[526] = 17'h17200; quarter[527] = 17'h1728a;
        quarter[528] = 17'h17315; quarter[529] = 17'h1739f; quarter[530] = 17'h1742a; quarter[531] = 17'h174b4;
        quarter[532] = 17'h1753d; quarter[533] = 17'h175c7; quarter[534] = 17'h17650; quarter[535] = 17'h176d9;
        quarter[536] = 17'h17762; quarter[537] = 17'h177eb; quarter[538] = 17'h17873; quarter[539] = 17'h178fb;
        quarter[540] = 17'h17983; quarter[541] = 17'h17a0b; quarter[542] = 17'h17a92; quarter[543] = 17'h17b1a;
        quarter[544] = 17'h17ba1; quarter[545] = 17'h17c27; quarter[546] = 17'h17cae; quarter[547] = 17'h17d34;
        quarter[548] = 17'h17dba; quarter[549] = 17'h17e40; quarter[550] = 17'h17ec6; quarter[551] = 17'h17f4b;
        quarter[552] = 17'h17fd1; quarter[553] = 17'h18056; quarter[554] = 17'h180da; quarter[555] = 17'h1815f;
        quarter[556] = 17'h181e3; quarter[557] = 17'h18267; quarter[558] = 17'h182eb; quarter[559] = 17'h1836e;
        quarter[560] = 17'h183f2; quarter[561] = 17'h18475; quarter[562] = 17'h184f8; quarter[563] = 17'h1857a;
        quarter[564] = 17'h185fd; quarter[565] = 17'h1867f; quarter[566] = 17'h18701; quarter[567] = 17'h18782;
        quarter[568] = 17'h18804; quarter[569] = 17'h18885; quarter[570] = 17'h18906; quarter[571] = 17'h18987;
        quarter[572] = 17'h18a07; quarter[573] = 17'h18a88; quarter[574] = 17'h18b08; quarter[575] = 17'h18b87;
        quarter[576] = 17'h18c07; quarter[577] = 17'h18c86; quarter[578] = 17'h18d05; quarter[579] = 17'h18d84;
        quarter[580] = 17'h18e03; quarter[581] = 17'h18e81; quarter[582] = 17'h18eff; quarter[583] = 17'h18f7d;
        quarter[584] = 17'h18ffb; quarter[585] = 17'h19078; quarter[586] = 17'h190f5; quarter[587] = 17'h19172;
        quarter[588] = 17'h191ef; quarter[589] = 17'h1926b; quarter[590] = 17'h192e8; quarter[591] = 17'h19363;
        quarter[592] = 17'h193df; quarter[593] = 17'h1945b; quarter[594] = 17'h194d6; quarter[595] = 17'h19551;
        quarter[596] = 17'h195cc; quarter[597] = 17'h19646; quarter[598] = 17'h196c0; quarter[599] = 17'h1973a;
        quarter[600] = 17'h197b4; quarter[601] = 17'h1982d; quarter[602] = 17'h198a7; quarter[603] = 17'h19920;
        quarter[604] = 17'h19998; quarter[605] = 17'h19a11; quarter[606] = 17'h19a89; quarter[607] = 17'h19b01;
        quarter[608] = 17'h19b79; quarter[609] = 17'h19bf1; quarter[610] = 17'h19c68; quarter[611] = 17'h19cdf;
        quarter[612] = 17'h19d56; quarter[613] = 17'h19dcc; quarter[614] = 17'h19e42; quarter[615] = 17'h19eb9;
        quarter[616] = 17'h19f2e; quarter[617] = 17'h19fa4; quarter[618] = 17'h1a019; quarter[619] = 17'h1a08e;
        quarter[620] = 17'h1a103; quarter[621] = 17'h1a177; quarter[622] = 17'h1a1ec; quarter[623] = 17'h1a260;
        quarter[624] = 17'h1a2d4; quarter[625] = 17'h1a347; quarter[626] = 17'h1a3ba; quarter[627] = 17'h1a42d;
        quarter[628] = 17'h1a4a0; quarter[629] = 17'h1a513; quarter[630] = 17'h1a585; quarter[631] = 17'h1a5f7;
        quarter[632] = 17'h1a669; quarter[633] = 17'h1a6da; quarter[634] = 17'h1a74b; quarter[635] = 17'h1a7bc;
        quarter[636] = 17'h1a82d; quarter[637] = 17'h1a89d; quarter[638] = 17'h1a90e; quarter[639] = 17'h1a97e;
        quarter[640] = 17'h1a9ed; quarter[641] = 17'h1aa5d; quarter[642] = 17'h1aacc; quarter[643] = 17'h1ab3b;
        quarter[644] = 17'h1abaa; quarter[645] = 17'h1ac18; quarter[646] = 17'h1ac86; quarter[647] = 17'h1acf4;
        quarter[648] = 17'h1ad62; quarter[649] = 17'h1adcf; quarter[650] = 17'h1ae3c; quarter[651] = 17'h1aea9;
        quarter[652] = 17'h1af16; quarter[653] = 17'h1af82; quarter[654] = 17'h1afee; quarter[655] = 17'h1b05a;
        quarter[656] = 17'h1b0c6; quarter[657] = 17'h1b131; quarter[658] = 17'h1b19c; quarter[659] = 17'h1b207;
        quarter[660] = 17'h1b271; quarter[661] = 17'h1b2db; quarter[662] = 17'h1b345; quarter[663] = 17'h1b3af;
        quarter[664] = 17'h1b419; quarter[665] = 17'h1b482; quarter[666] = 17'h1b4eb; quarter[667] = 17'h1b554;
        quarter[668] = 17'h1b5bc; quarter[669] = 17'h1b624; quarter[670] = 17'h1b68c; quarter[671] = 17'h1b6f4;
        quarter[672] = 17'h1b75b; quarter[673] = 17'h1b7c2; quarter[674] = 17'h1b829; quarter[675] = 17'h1b890;
        quarter[676] = 17'h1b8f6; quarter[677] = 17'h1b95c; quarter[678] = 17'h1b9c2; quarter[679] = 17'h1ba27;
        quarter[680] = 17'h1ba8c; quarter[681] = 17'h1baf1; quarter[682] = 17'h1bb56; quarter[683] = 17'h1bbba;
        quarter[684] = 17'h1bc1f; quarter[685] = 17'h1bc83; quarter[686] = 17'h1bce6; quarter[687] = 17'h1bd4a;
        quarter[688] = 17'h1bdad; quarter[689] = 17'h1be10; quarter[690] = 17'h1be72; quarter[691] = 17'h1bed4;
        quarter[692] = 17'h1bf36; quarter[693] = 17'h1bf98; quarter[694] = 17'h1bffa; quarter[695] = 17'h1c05b;
        quarter[696] = 17'h1c0bc; quarter[697] = 17'h1c11d; quarter[698] = 17'h1c17d; quarter[699] = 17'h1c1dd;
        quarter[700] = 17'h1c23d; quarter[701] = 17'h1c29d; quarter[702] = 17'h1c2fc; quarter[703] = 17'h1c35b;
        quarter[704] = 17'h1c3ba; quarter[705] = 17'h1c418; quarter[706] = 17'h1c476; quarter[707] = 17'h1c4d4;
        quarter[708] = 17'h1c532; quarter[709] = 17'h1c58f; quarter[710] = 17'h1c5ed; quarter[711] = 17'h1c649;
        quarter[712] = 17'h1c6a6; quarter[713] = 17'h1c702; quarter[714] = 17'h1c75e; quarter[715] = 17'h1c7ba;
        quarter[716] = 17'h1c816; quarter[717] = 17'h1c871; quarter[718] = 17'h1c8cc; quarter[719] = 17'h1c927;
        quarter[720] = 17'h1c981; quarter[721] = 17'h1c9db; quarter[722] = 17'h1ca35; quarter[723] = 17'h1ca8f;
        quarter[724] = 17'h1cae8; quarter[725] = 17'h1cb41; quarter[726] = 17'h1cb9a; quarter[727] = 17'h1cbf2;
        quarter[728] = 17'h1cc4a; quarter[729] = 17'h1cca2; quarter[730] = 17'h1ccfa; quarter[731] = 17'h1cd51;
        quarter[732] = 17'h1cda8; quarter[733] = 17'h1cdff; quarter[734] = 17'h1ce56; quarter[735] = 17'h1ceac;
        quarter[736] = 17'h1cf02; quarter[737] = 17'h1cf57; quarter[738] = 17'h1cfad; quarter[739] = 17'h1d002;
        quarter[740] = 17'h1d057; quarter[741] = 17'h1d0ab; quarter[742] = 17'h1d100; quarter[743] = 17'h1d154;
        quarter[744] = 17'h1d1a7; quarter[745] = 17'h1d1fb; quarter[746] = 17'h1d24e; quarter[747] = 17'h1d2a1;
        quarter[748] = 17'h1d2f3; quarter[749] = 17'h1d346; quarter[750] = 17'h1d398; quarter[751] = 17'h1d3ea;
        quarter[752] = 17'h1d43b; quarter[753] = 17'h1d48c; quarter[754] = 17'h1d4dd; quarter[755] = 17'h1d52e;
        quarter[756] = 17'h1d57e; quarter[757] = 17'h1d5ce; quarter[758] = 17'h1d61e; quarter[759] = 17'h1d66e;
        quarter[760] = 17'h1d6bd; quarter[761] = 17'h1d70c; quarter[762] = 17'h1d75a; quarter[763] = 17'h1d7a9;
        quarter[764] = 17'h1d7f7; quarter[765] = 17'h1d845; quarter[766] = 17'h1d892; quarter[767] = 17'h1d8df;
        quarter[768] = 17'h1d92c; quarter[769] = 17'h1d979; quarter[770] = 17'h1d9c5; quarter[771] = 17'h1da11;
        quarter[772] = 17'h1da5d; quarter[773] = 17'h1daa9; quarter[774] = 17'h1daf4; quarter[775] = 17'h1db3f;
        quarter[776] = 17'h1db8a; quarter[777] = 17'h1dbd4; quarter[778] = 17'h1dc1e; quarter[779] = 17'h1dc68;
        quarter[780] = 17'h1dcb1; quarter[781] = 17'h1dcfa; quarter[782] = 17'h1dd43; quarter[783] = 17'h1dd8c;
        quarter[784] = 17'h1ddd4; quarter[785] = 17'h1de1d; quarter[786] = 17'h1de64; quarter[787] = 17'h1deac;
        quarter[788] = 17'h1def3; quarter[789] = 17'h1df3a; quarter[790] = 17'h1df81; quarter[791] = 17'h1dfc7;
        quarter[792] = 17'h1e00d; quarter[793] = 17'h1e053; quarter[794] = 17'h1e098; quarter[795] = 17'h1e0dd;
        quarter[796] = 17'h1e122; quarter[797] = 17'h1e167; quarter[798] = 17'h1e1ab; quarter[799] = 17'h1e1ef;
        quarter[800] = 17'h1e233; quarter[801] = 17'h1e276; quarter[802] = 17'h1e2ba; quarter[803] = 17'h1e2fc;
        quarter[804] = 17'h1e33f; quarter[805] = 17'h1e381; quarter[806] = 17'h1e3c3; quarter[807] = 17'h1e405;
        quarter[808] = 17'h1e446; quarter[809] = 17'h1e487; quarter[810] = 17'h1e4c8; quarter[811] = 17'h1e509;
        quarter[812] = 17'h1e549; quarter[813] = 17'h1e589; quarter[814] = 17'h1e5c9; quarter[815] = 17'h1e608;
        quarter[816] = 17'h1e647; quarter[817] = 17'h1e686; quarter[818] = 17'h1e6c4; quarter[819] = 17'h1e703;
        quarter[820] = 17'h1e740; quarter[821] = 17'h1e77e; quarter[822] = 17'h1e7bb; quarter[823] = 17'h1e7f8;
        quarter[824] = 17'h1e835; quarter[825] = 17'h1e872; quarter[826] = 17'h1e8ae; quarter[827] = 17'h1e8e9;
        quarter[828] = 17'h1e925; quarter[829] = 17'h1e960; quarter[830] = 17'h1e99b; quarter[831] = 17'h1e9d6;
        quarter[832] = 17'h1ea10; quarter[833] = 17'h1ea4a; quarter[834] = 17'h1ea84; quarter[835] = 17'h1eabe;
        quarter[836] = 17'h1eaf7; quarter[837] = 17'h1eb30; quarter[838] = 17'h1eb68; quarter[839] = 17'h1eba1;
        quarter[840] = 17'h1ebd9; quarter[841] = 17'h1ec10; quarter[842] = 17'h1ec48; quarter[843] = 17'h1ec7f;
        quarter[844] = 17'h1ecb6; quarter[845] = 17'h1ecec; quarter[846] = 17'h1ed22; quarter[847] = 17'h1ed58;
        quarter[848] = 17'h1ed8e; quarter[849] = 17'h1edc3; quarter[850] = 17'h1edf8; quarter[851] = 17'h1ee2d;
        quarter[852] = 17'h1ee61; quarter[853] = 17'h1ee96; quarter[854] = 17'h1eec9; quarter[855] = 17'h1eefd;
        quarter[856] = 17'h1ef30; quarter[857] = 17'h1ef63; quarter[858] = 17'h1ef96; quarter[859] = 17'h1efc8;
        quarter[860] = 17'h1effa; quarter[861] = 17'h1f02c; quarter[862] = 17'h1f05d; quarter[863] = 17'h1f08f;
        quarter[864] = 17'h1f0bf; quarter[865] = 17'h1f0f0; quarter[866] = 17'h1f120; quarter[867] = 17'h1f150;
        quarter[868] = 17'h1f180; quarter[869] = 17'h1f1af; quarter[870] = 17'h1f1de; quarter[871] = 17'h1f20d;
        quarter[872] = 17'h1f23b; quarter[873] = 17'h1f26a; quarter[874] = 17'h1f297; quarter[875] = 17'h1f2c5;
        quarter[876] = 17'h1f2f2; quarter[877] = 17'h1f31f; quarter[878] = 17'h1f34c; quarter[879] = 17'h1f378;
        quarter[880] = 17'h1f3a4; quarter[881] = 17'h1f3d0; quarter[882] = 17'h1f3fb; quarter[883] = 17'h1f427;
        quarter[884] = 17'h1f451; quarter[885] = 17'h1f47c; quarter[886] = 17'h1f4a6; quarter[887] = 17'h1f4d0;
        quarter[888] = 17'h1f4fa; quarter[889] = 17'h1f523; quarter[890] = 17'h1f54c; quarter[891] = 17'h1f575;
        quarter[892] = 17'h1f59d; quarter[893] = 17'h1f5c6; quarter[894] = 17'h1f5ed; quarter[895] = 17'h1f615;
        quarter[896] = 17'h1f63c; quarter[897] = 17'h1f663; quarter[898] = 17'h1f68a; quarter[899] = 17'h1f6b0;
        quarter[900] = 17'h1f6d6; quarter[901] = 17'h1f6fc; quarter[902] = 17'h1f721; quarter[903] = 17'h1f746;
        quarter[904] = 17'h1f76b; quarter[905] = 17'h1f78f; quarter[906] = 17'h1f7b4; quarter[907] = 17'h1f7d8;
        quarter[908] = 17'h1f7fb; quarter[909] = 17'h1f81e; quarter[910] = 17'h1f841; quarter[911] = 17'h1f864;
        quarter[912] = 17'h1f886; quarter[913] = 17'h1f8a9; quarter[914] = 17'h1f8ca; quarter[915] = 17'h1f8ec;
        quarter[916] = 17'h1f90d; quarter[917] = 17'h1f92e; quarter[918] = 17'h1f94e; quarter[919] = 17'h1f96f;
        quarter[920] = 17'h1f98f; quarter[921] = 17'h1f9ae; quarter[922] = 17'h1f9cd; quarter[923] = 17'h1f9ed;
        quarter[924] = 17'h1fa0b; quarter[925] = 17'h1fa2a; quarter[926] = 17'h1fa48; quarter[927] = 17'h1fa66;
        quarter[928] = 17'h1fa83; quarter[929] = 17'h1faa0; quarter[930] = 17'h1fabd; quarter[931] = 17'h1fada;
        quarter[932] = 17'h1faf6; quarter[933] = 17'h1fb12; quarter[934] = 17'h1fb2e; quarter[935] = 17'h1fb49;
        quarter[936] = 17'h1fb64; quarter[937] = 17'h1fb7f; quarter[938] = 17'h1fb99; quarter[939] = 17'h1fbb3;
        quarter[940] = 17'h1fbcd; quarter[941] = 17'h1fbe7; quarter[942] = 17'h1fc00; quarter[943] = 17'h1fc19;
        quarter[944] = 17'h1fc32; quarter[945] = 17'h1fc4a; quarter[946] = 17'h1fc62; quarter[947] = 17'h1fc7a;
        quarter[948] = 17'h1fc91; quarter[949] = 17'h1fca8; quarter[950] = 17'h1fcbf; quarter[951] = 17'h1fcd5;
        quarter[952] = 17'h1fceb; quarter[953] = 17'h1fd01; quarter[954] = 17'h1fd17; quarter[955] = 17'h1fd2c;
        quarter[956] = 17'h1fd41; quarter[957] = 17'h1fd56; quarter[958] = 17'h1fd6a; quarter[959] = 17'h1fd7e;
        quarter[960] = 17'h1fd92; quarter[961] = 17'h1fda5; quarter[962] = 17'h1fdb8; quarter[963] = 17'h1fdcb;
        quarter[964] = 17'h1fddd; quarter[965] = 17'h1fdf0; quarter[966] = 17'h1fe01; quarter[967] = 17'h1fe13;
        quarter[968] = 17'h1fe24; quarter[969] = 17'h1fe35; quarter[970] = 17'h1fe46; quarter[971] = 17'h1fe56;
        quarter[972] = 17'h1fe66; quarter[973] = 17'h1fe76; quarter[974] = 17'h1fe85; quarter[975] = 17'h1fe94;
        quarter[976] = 17'h1fea3; quarter[977] = 17'h1feb2; quarter[978] = 17'h1fec0; quarter[979] = 17'h1fece;
        quarter[980] = 17'h1fedb; quarter[981] = 17'h1fee9; quarter[982] = 17'h1fef5; quarter[983] = 17'h1ff02;
        quarter[984] = 17'h1ff0e; quarter[985] = 17'h1ff1a; quarter[986] = 17'h1ff26; quarter[987] = 17'h1ff32;
        quarter[988] = 17'h1ff3d; quarter[989] = 17'h1ff47; quarter[990] = 17'h1ff52; quarter[991] = 17'h1ff5c;
        quarter[992] = 17'h1ff66; quarter[993] = 17'h1ff70; quarter[994] = 17'h1ff79; quarter[995] = 17'h1ff82;
        quarter[996] = 17'h1ff8a; quarter[997] = 17'h1ff93; quarter[998] = 17'h1ff9b; quarter[999] = 17'h1ffa2;
        quarter[1000] = 17'h1ffaa; quarter[1001] = 17'h1ffb1; quarter[1002] = 17'h1ffb8; quarter[1003] = 17'h1ffbe;
        quarter[1004] = 17'h1ffc4; quarter[1005] = 17'h1ffca; quarter[1006] = 17'h1ffd0; quarter[1007] = 17'h1ffd5;
        quarter[1008] = 17'h1ffda; quarter[1009] = 17'h1ffdf; quarter[1010] = 17'h1ffe3; quarter[1011] = 17'h1ffe7;
        quarter[1012] = 17'h1ffeb; quarter[1013] = 17'h1ffee; quarter[1014] = 17'h1fff1; quarter[1015] = 17'h1fff4;
        quarter[1016] = 17'h1fff6; quarter[1017] = 17'h1fff8; quarter[1018] = 17'h1fffa; quarter[1019] = 17'h1fffc;
        quarter[1020] = 17'h1fffd; quarter[1021] = 17'h1fffe; quarter[1022] = 17'h1ffff; quarter[1023] = 17'h1ffff;
    end

    always @(posedge clock) begin
        quarter_word <= quarter[angle[30] ? difference_35[9:0] : angle[29:20]];
    end

    always @(posedge clock) begin
        if (reset) begin
            step <= 3'd0;
            phase <= 32'd0;
            window_phase <= 32'd0;
            negative <= 1'd0;
            wave <= 17'd0;
            sign <= 1'd0;
            cosine <= 18'd0;
            sine <= 18'd0;
            window <= 18'd0;
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
                    : step_is_cosine ? ((rounded[19:17] == {3{rounded[19]}}) ? rounded[17:0] : {rounded[19], {17{~rounded[19]}}})
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
    wire unused = &{1'b0, sum_31[32], angle[19:0], difference_35[10], choice_48[3], sum_51[32], sum_55[32]};

endmodule

`default_nettype wire

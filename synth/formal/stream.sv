// SPDX-License-Identifier: MIT OR Apache-2.0
// Stream: what goes to the transmitter is whole packets of one length, each with its CRC; END is at their ends and nowhere else;
// each byte before it is the payload's, or the distance to the zero byte before where the payload's is zero (`plain`), and the
// last one is such a distance; a packet's number is one number; a frame is sent with the words that came with it, or dropped
// whole and told; a heartbeat whose words are written meanwhile ends early, and one that does not has each of its words whole.
//
// Appended to the printed module; parameters: BYTES (of a word), WIDTH (its bits), STATUS (bytes before the words), VERSION (of
// heartbeats). `line` is what goes into the transmitter.

    localparam LENGTH = STATUS + 8 * BYTES + 6;
    localparam CRC = LENGTH - 6;

    function [31:0] check_of(input [31:0] before, input [7:0] next);
        integer k;
        begin
            check_of = before;
            for (k = 0; k < 8; k = k + 1)
                check_of = {1'b0, check_of[31:1]} ^ ((check_of[0] ^ next[k]) ? 32'hedb88320 : 32'h00000000);
        end
    endfunction

    reg was_reset = 0;
    always @(posedge clock) was_reset <= 1;
    always @(*) if (!was_reset) assume (reset);

    // The words of a frame come one after the other, without a pause.
    reg [3:0] due = 0;
    always @(posedge clock) due <= reset ? 0 : valid ? (index == 7 ? 0 : due + 1) : due;
    always @(*) if (was_reset) begin
        assume (!valid || index == due);
        assume (valid || due == 0);
        assume (done == (valid && index == 7));
        // Frames are further apart than a packet's first two bytes take, its number.
        assume (!(done && busy && group == 15 && left >= STATUS - 2));
    end

    // The bytes that go out: how many of a packet have gone, how far the packet's last zero byte is behind (or what stands before
    // its first byte), and the CRC of the payload.
    wire sent = transmitter_taken;
    reg [7:0] at = 0;
    reg [7:0] since = 1;
    reg [31:0] check = 32'hffffffff;
    reg [7:0] upper = 0;
    wire end_byte = line == 0;
    wire last = at == LENGTH - 1;
    always @(posedge clock) begin
        if (reset || (sent && end_byte)) begin
            at <= 0;
            since <= 1;
            check <= 32'hffffffff;
        end else if (sent) begin
            at <= at + 1;
            since <= plain == 0 ? 1 : since + 1;
            if (at < CRC) check <= check_of(check, plain);
            if (at == 0) upper <= plain;
        end
    end
    // Bits of the CRC that have gone.
    wire [5:0] gone = at < CRC ? 0 : 8 * (at - CRC);
    wire [31:0] ahead = ~check >> gone;

    // Any one word of a frame that is taken, and whether that frame is the one that is being sent.
    (* anyconst *) reg [2:0] which;
    reg [WIDTH-1:0] word = 0;
    reg accepted = 0, accepting = 0;
    reg before_busy = 0, before_end = 0, before_done = 0, before_idle = 0, past_valid = 0;
    reg [15:0] before_number = 0;
    reg before_sent = 0, before_wrote = 0;
    // What is to be told, and whether the byte that tells it, the fourth, was sent in the clock before.
    reg [2:0] before_events = 0;
    reg before_told = 0;
    // A word for heartbeats is written while no frame comes and no byte is read.
    wire wrote = keep_q && !valid && !transmitter_ending;
    // A word for heartbeats was written while one is being sent, which ends early.
    reg cut = 0;
    // The word of a heartbeat as it was when its first byte went.
    reg signed [WIDTH-1:0] begun = 0;
    always @(posedge clock) begin
        past_valid <= was_reset && !reset;
        before_busy <= busy;
        before_end <= sent && end_byte;
        before_done <= done;
        before_idle <= accepting || (valid && index == 0 && !busy);
        before_number <= number;
        before_sent <= sent;
        before_events <= {late | late_q, refused | refused_q, overrun};
        before_told <= sent && at == 3;
        before_wrote <= wrote;
        cut <= !reset && busy && heartbeat && (cut ? !sent : wrote && group < 8);
        if (sent && group == which && left == BYTES - 1) begun <= words[{1'b1, which}];
        if (reset) begin
            accepting <= 0;
            accepted <= 0;
        end else begin
            if (valid && index == 0) accepting <= !busy;
            if (done) accepting <= 0;
            if (valid && index == which && (index == 0 ? !busy : accepting)) word <= frame;
            // A heartbeat begins only between frames.
            if (done && (accepting && due != 0)) accepted <= 1;
            else if (sent && end_byte) accepted <= 0;
        end
    end

    // The word that is due, as it lies in the memory.
    wire [3:0] place_in_memory = {heartbeat, group[2:0]};
    wire signed [WIDTH-1:0] stored = words[place_in_memory];

    // Where the packet stands, by group and bytes left.
    wire [7:0] place_of = group == 15 ? STATUS - 1 - left : group == 8 ? CRC + 5 - left : STATUS + BYTES * group + BYTES - 1 - left;
    wire [8*BYTES-1:0] wide = {{8 * BYTES - WIDTH + 1{word[WIDTH-1]}}, word[WIDTH-2:0]};
    wire [8*BYTES-1:0] moved = wide >> (8 * left);

    wire [8*BYTES-1:0] begun_wide = {{8 * BYTES - WIDTH + 1{begun[WIDTH-1]}}, begun[WIDTH-2:0]};
    wire [8*BYTES-1:0] begun_moved = begun_wide >> (8 * left);

    always @(posedge clock) if (was_reset) begin
        // Invariants.
        if (cut) assert (busy && heartbeat && group == 8 && left == 0 && at >= STATUS && at <= CRC);
        if (busy && !cut) assert (at == place_of && group != 9 && group != 10 && group != 11 && group != 12 && group != 13 && group != 14);
        if (busy) assert (left < (group == 15 ? STATUS : group == 8 ? 6 : BYTES));
        if (!busy) assert (at == 0 && since == 1 && check == 32'hffffffff);
        if (busy) assert (distance == since && since != 0 && since <= at + 1);
        assert (accepting == (due != 0 && taking));
        assert (!(accepting && busy));
        assert (accepted == (busy && !heartbeat));
        if (busy && at <= CRC) assert (crc == check);
        if (busy && !cut && gone < 32) assert (((crc ^ ~ahead) << gone) == 0);
        if (busy && at == 1) assert (upper == number[15:8]);
        if (busy && heartbeat) assert ({lost_q, invalid_q, saturated_q} == VERSION && !lifted_q);
        if (busy && group < 8 && !before_sent && !before_wrote) assert (words_word == stored);
        if (busy && heartbeat && group == which && left < BYTES - 1) assert (words[{1'b1, which}] == begun);
        if ((accepting && which < due) || accepted) assert (words[which] == word);
        // Properties.
        if (sent) begin
            assert (busy);
            assert (line == (last || cut ? 0 : plain != 0 ? plain : since));
            assert (end_byte == (last || cut));
            if (at == 1) assert ({upper, plain} == number);
            if (!cut && at >= CRC && at < CRC + 4) assert (plain == ahead[7:0]);
            if (!cut && at == CRC + 4) assert (plain == 0);
            if (accepted && group == which) assert (plain == moved[7:0]);
            if (heartbeat && group == which && left < BYTES - 1) assert (plain == begun_moved[7:0]);
        end
        if (past_valid) begin
            // A packet that has begun ends with its END.
            assert (busy || !before_busy || before_end);
            // What happened stays until it is told.
            if (!before_told) assert ((before_events & ~{late_q, refused_q, overrun}) == 0);
            // A frame counts, and is told where it is dropped.
            assert (number == before_number + before_done);
            if (before_done && !before_idle) assert (overrun);
            if (before_done && before_idle) assert (busy && at == 0 && !heartbeat);
        end
    end

    // Cover: the properties are not vacuous. (Whole packets of either kind, zero bytes, and frames that are dropped take thousands of
    // clocks: they happen in the lock-step of `tests/tests/board_faults.rs`.)
    always @(posedge clock) if (was_reset) begin
        cover (sent && accepted && word != 0);
        cover (busy && accepted && before_sent);
    end

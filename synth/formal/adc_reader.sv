// SPDX-License-Identifier: MIT OR Apache-2.0
// ADC reader: whenever it is enabled, disabled or told to send a word, CS is low for a whole read or a whole word, SCLK has
// exactly its pulses, SDI may move only in words (`shift` changes with CS alone), sets are stored whole, and while it is
// enabled conversions are PERIOD clocks apart.
//
// Appended to the printed module; parameters: PERIOD, CONVERSION, BITS, LATENCY (of SCLK's output) and CHANNELS.

    localparam COMMAND = 16;
    reg was_reset = 0;
    reg past_valid = 0;
    // How long CS has been low, and SCLK has run.
    reg [7:0] low_for = 0, run_for = 0;
    // How long ago a conversion was begun, the reader having been enabled all along.
    reg [31:0] since = 0;
    reg held = 0;
    reg before_low = 0, before_shift = 0, before_convst = 0, before_last = 0, before_run = 0, before_store = 0;
    reg [2:0] before_index = 0;
    // The pulses at the pin.
    reg [3:0] late_run = 0;
    wire pulse = LATENCY == 0 ? sclk_run : late_run[LATENCY - 1];
    wire [7:0] length = configuring ? COMMAND : BITS;
    wire low = !cs_n;
    // Where a clock of a read stands in the period.
    wire [15:0] of_low = CONVERSION + low_for;
    wire [15:0] of_run = CONVERSION + 1 - LATENCY + run_for;
    wire [15:0] low_phase = of_low >= PERIOD ? of_low - PERIOD : of_low;
    wire [15:0] run_phase = of_run >= PERIOD ? of_run - PERIOD : of_run;
    wire [15:0] of_store = CONVERSION + BITS + 1 + index;
    wire [15:0] store_phase = of_store >= PERIOD ? of_store - PERIOD : of_store;
    wire rise = convst && !before_convst;
    // These count the clock that is there.
    always @(posedge clock) begin
        was_reset <= 1;
        past_valid <= !reset;
        before_low <= !reset && low;
        before_shift <= !reset && shift;
        before_convst <= !reset && convst;
        before_run <= !reset && sclk_run;
        before_store <= !reset && store;
        before_index <= index;
        before_last <= !reset && store && index == CHANNELS - 1 && enable;
        late_run <= reset ? 0 : {late_run[2:0], sclk_run};
    end
    always @(posedge clock) begin
        if (reset) begin
            low_for <= 0;
            run_for <= 0;
            held <= 0;
        end else begin
            low_for <= will_low ? low_for + 1 : 0;
            run_for <= will_run ? run_for + 1 : 0;
            held <= enable && (held || bit_begins);
            since <= bit_begins ? 1 : since + 1;
        end
    end
    // What the registers take at the end of this clock, in the schedule's own words.
    wire reads = active || configuring;
    wire moves = enable || active || selected || unload || configuring;
    wire bit_begins = moves && phase == 0 && enable && !configuring;
    wire will_low = moves && (selected ? low_for != length + 1 : (phase == CONVERSION && reads));
    wire will_run = moves && (run ? run_for != length : (phase == CONVERSION + 1 - LATENCY && reads));
    always @(*) if (!was_reset) assume (reset);

    always @(posedge clock) if (was_reset) begin
        // Invariants.
        assert (phase < PERIOD);
        assert (low == (low_for != 0) && sclk_run == (run_for != 0));
        assert (low_for <= length + 1 && run_for <= length);
        if (low) assert (phase == low_phase);
        if (sclk_run) assert (phase == run_phase);
        if (active) assert (!configuring && phase >= 1 && phase <= CONVERSION + 1);
        if (configuring && !low) assert (phase <= CONVERSION);
        if (low && low_for + LATENCY > 1 && low_for + LATENCY - 1 <= length) assert (run_for == low_for + LATENCY - 1);
        if (sclk_run && run_for > LATENCY - 1 && run_for + 1 > LATENCY) assert (low_for == run_for + 1 - LATENCY);
        if (sclk_run && run_for + 1 <= LATENCY) assert (!low || low_for == length + 1);
        if (sclk_run && run_for + 1 <= LATENCY) assert (reads);
        assert (!(held && configuring));
        if (held) assert (since >= 1 && since <= PERIOD && phase == (since == PERIOD ? 0 : since));
        if (!unload) assert (index == 0);
        if (unload) assert (!configuring && phase == store_phase);
        assert (index < CHANNELS);
        // Properties: CS is low for a whole read or word.
        if (past_valid && before_low && !low) assert (past_length == past_low - 1);
        // SCLK runs while CS is low, after its first clock, for as many pulses as there are bits.
        if (past_valid && pulse) assert (low && before_low);
        // SDI moves in words only.
        if (past_valid && low && before_low) assert (shift == before_shift);
        if (shift) assert (low);
        // Conversions keep their pace, and none is begun while a word is being sent.
        if (past_valid && rise && held_before) assert (since_before == PERIOD);
        if (rise) assert (!configuring);
        // A set is stored from its first channel to its last; what strobes is whole, and enabled.
        if (past_valid && before_store && store) assert (index == before_index + 1);
        if (past_valid && before_store && !store) assert (before_index == CHANNELS - 1);
        assert (!strobe || before_last);
    end

    reg [7:0] past_length = 0, past_low = 0;
    reg held_before = 0;
    reg [31:0] since_before = 0;
    always @(posedge clock) begin
        past_length <= length;
        past_low <= low_for;
        held_before <= !reset && held && enable;
        since_before <= since;
    end

    // Cover: a set that strobes, and a word that is sent.
    always @(posedge clock) if (was_reset) begin
        cover (strobe);
        cover (before_low && !low && before_shift);
        cover (strobe && late);
    end

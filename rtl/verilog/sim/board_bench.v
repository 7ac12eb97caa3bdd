// SPDX-License-Identifier: MIT OR Apache-2.0
// Bench of a board's top with an ADC model at its pins and a host at its serial line: sends the bytes of one file, writes the
// received bytes to another, one per line, and ends after PACKETS frames (heartbeats do not count). Output pins change T_OUT ns
// after their clock; data lines take T_IN ns to the core. With DRIVE defined the top has a serial converter of 24 bits a frame,
// an AD5664, whose frames go to a third file.

`timescale 1ns / 1ps
`default_nettype none

module board_bench #(
    parameter BITS = 16,
    parameter SAMPLES = 1,
    parameter BYTES = 1,
    parameter PACKETS = 1,
    parameter real PERIOD = 83.333,
    parameter real BIT = 1000.0,
    parameter real T_OUT = 4.0,
    parameter real T_IN = 4.0,
    parameter LIMIT_MS = 1000,
    parameter ACTIVE_LOW = 0
);

    reg clock, rx;
    wire tx, adc_reset, convst, busy, cs_n, sclk, sdi, carrier, enabled, late;
    wire [7:0] dout;
    wire [3:0] pads;
    reg convst_pin, cs_n_pin, sdi_pin;
    reg [7:0] dout_in;
    reg [7:0] bytes [0:BYTES-1];
    reg [7:0] heard;
    integer file, packets, k, bit_number;

    // No continuous assignments with delays: Verilator evaluates them at every edge of the clock.
    always @(convst, cs_n, sdi) #(T_OUT) {convst_pin, cs_n_pin, sdi_pin} = {convst, cs_n, sdi};
    always @(dout) dout_in <= #(T_IN) dout;

`ifdef DRIVE
    wire dac_sync_n, dac_sclk, dac_sdi, dac_live;
    wire [3:0] dac_polarity;
`endif

    top uut (
        .clock(clock), .button(ACTIVE_LOW != 0), .rx(rx), .tx(tx), .adc_reset(adc_reset), .convst(convst), .busy(busy),
        .cs_n(cs_n), .sclk(sclk), .sdi(sdi), .dout(dout_in), .carrier(carrier), .pads(pads), .enabled(enabled), .late(late)
`ifdef DRIVE
        , .dac_sync_n(dac_sync_n), .dac_sclk(dac_sclk), .dac_sdi(dac_sdi), .dac_polarity(dac_polarity), .dac_live(dac_live)
`endif
    );

`ifdef DRIVE
    reg [23:0] dac_frame;
    integer dac_file, dac_bits;
    initial dac_file = $fopen("dac.hex", "w");
    always @(negedge dac_sync_n) dac_bits = 0;
    always @(negedge dac_sclk) if (!dac_sync_n) begin
        dac_frame = {dac_frame[22:0], dac_sdi};
        dac_bits = dac_bits + 1;
        if (dac_bits == 24) $fdisplay(dac_file, "%06x", dac_frame);
    end
    always @(posedge dac_sync_n) if ($realtime > 600 * PERIOD && dac_bits != 24)
        $display("a frame of %0d bits for the converter", dac_bits);
`endif

    adc_model #(.BITS(BITS), .SAMPLES(SAMPLES)) adc (
        .reset(adc_reset), .convst(convst_pin), .cs_n(cs_n_pin), .sclk(sclk), .sdi(sdi_pin), .busy(busy), .dout(dout)
    );

    initial begin
        clock = 0;
        forever #(PERIOD / 2) clock = !clock;
    end

    initial begin
        rx = 1;
        $readmemh("bytes.hex", bytes);
        #(600 * PERIOD);
        for (k = 0; k < BYTES; k = k + 1) begin
            rx = 0;
            #(BIT);
            for (bit_number = 0; bit_number < 8; bit_number = bit_number + 1) begin
                rx = bytes[k][bit_number];
                #(BIT);
            end
            rx = 1;
            #(BIT);
        end
    end

    // The fourth byte of a packet, its flags or, where these are zero, a small distance, says whether it is a heartbeat.
    integer heard_bit, place;
    reg heartbeat;
    initial begin
        file = $fopen("heard.hex", "w");
        packets = 0;
        place = 0;
        heartbeat = 0;
        #(600 * PERIOD);
        while (packets < PACKETS) begin
            @(negedge tx);
            #(BIT / 2);
            for (heard_bit = 0; heard_bit < 8; heard_bit = heard_bit + 1) begin
                #(BIT);
                heard[heard_bit] = tx;
            end
            $fdisplay(file, "%02x", heard);
            if (heard === 8'h00) begin
                if (place > 4 && !heartbeat) packets = packets + 1;
                place = 0;
            end else begin
                if (place == 3) heartbeat = heard[7];
                place = place + 1;
            end
            #(BIT);
        end
        $fclose(file);
        $display("faults %0d, commands %0d", adc.faults, adc.commands);
        $finish;
    end

    // Break before make, whatever the core says.
    reg [3:0] closed;
    initial closed = 0;
    always @(pads) if ($realtime > 600 * PERIOD) begin
        if ((pads & (pads - 1)) != 0) $display("two pads closed: %b", pads);
        if (pads != 0 && closed != 0) $display("%b to %b without a break", closed, pads);
        closed = pads;
    end

    initial begin
        // Not in one delay: Verilator counts one in 32 bits of the precision.
        repeat (LIMIT_MS) #1000000;
        $display("no end after %0d packets", packets);
        $finish;
    end

endmodule

`default_nettype wire

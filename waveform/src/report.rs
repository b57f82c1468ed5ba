//! The table that is printed.

use atc_waveform::measure::Bench;

/// The lines of the table.
pub fn table(bench: &Bench) -> Vec<String> {
    let mut lines = vec![format!("Bit errors ({})", bench.receiver)];
    for curve in &bench.bit_errors {
        lines.push(format!("\n  {}", curve.name));
        lines.push("  Eb/N0 dB      bits   errors      rate    theory   loss dB".into());
        for point in &curve.points {
            lines.push(format!(
                "  {:8.0} {:9} {:8} {:9.2e} {:9.2e} {:>9}",
                point.eb_n0_db,
                point.bits,
                point.errors,
                point.rate,
                point.theory,
                point.loss_db.map_or_else(|| "few".into(), |loss| format!("{loss:.2}"))
            ));
        }
    }
    lines.push("\nTime from the start of the signal to the first right report, in seconds".into());
    lines.push("                        speed by codes            main telegram".into());
    lines.push("    SNR dB  Eb/N0 dB    heard  median   95 %      heard  median   95 %   wrong".into());
    let seconds = |time: Option<f64>| time.map_or_else(|| "–".into(), |time| format!("{time:.2}"));
    for point in &bench.detection {
        let times = [&point.code, &point.main_telegram].map(|times| {
            format!("{:6.1} % {:>6} {:>6}", 100.0 * times.heard, seconds(times.median), seconds(times.percentile_95))
        });
        let wrong = point.wrong_speeds + point.wrong_telegrams;
        let [code, telegram] = times;
        lines.push(format!("  {:8.0} {:9.0} {code}   {telegram} {wrong:7}", point.snr_db, point.eb_n0_db));
    }
    let codes = &bench.false_codes;
    lines.push(format!(
        "\nNoise alone: {} windows of {} s, one every {} s (as long as {} that do not overlap): {} frequencies reported, {} of \
         them codes, {} speeds; code rate {}{:.1e} a window",
        codes.windows,
        codes.window_s,
        codes.hop_s,
        codes.disjoint_windows,
        codes.reports,
        codes.codes,
        codes.speeds,
        if codes.codes == 0 { "below " } else { "" },
        codes.code_rate
    ));
    let speed = &bench.throughput;
    lines.push(format!(
        "\nTimes real time on one core: transmitter {:.0}, conventional receiver {:.0}, on-board receiver {:.0}, track circuit \
         receiver {:.0}",
        speed.transmitter, speed.conventional, speed.on_board, speed.track_circuit
    ));
    lines
}

# SPDX-License-Identifier: GPL-3.0-or-later
"""The part `trials` of results.py: runs the studies of the shipped scenarios and tells them beside study and bound."""
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import shutil
import statistics
import subprocess
import sys

import numpy as np
from scipy.stats import beta

ROOT = pathlib.Path(__file__).resolve().parents[1]
TRIAL = ROOT / "build" / "release" / "apps" / "eyeslam-trial"
REPLAY = TRIAL.with_name("eyeslam-replay")
CHECK = ROOT / "scripts" / "check_trial_log.py"
OUT = ROOT / "out" / "results" / "trials"
FAST = ("camera_hz=120", "latency_ms=5")  # 120/5
# Scenario, settings: what is swept in one call.
STUDIES = {
    "tracing": ("vessel_tracing", ("aid=none hard",)),
    "tracing_soft": ("vessel_tracing", ("aid=soft",)),
    "laser": ("laser_rings", ("aid=manual automated", "motion=in_situ jerky")),
    "tracing_eye": ("vessel_tracing", ("aid=none hard", "motion=jerky saccade")),
    "tracing_120": ("vessel_tracing", ("aid=hard", "motion=in_situ jerky", *FAST)),  # a bare hand knows no camera
    "laser_120": ("laser_rings", ("aid=automated", *FAST)),
}
PROVED = ("laser", "laser_120")  # pulse by pulse from their logs, by scripts/check_trial_log.py
CALIBRES = ("50_um_or_more", "20_to_50_um", "below_20_um")


def is_variant(file, row):
    """Whether a folder such as aid=hard,motion=jerky/seed_0003 is that of a row."""
    swept = dict(word.split("=", 1) for word in file.parent.parent.name.split(",") if "=" in word)
    return all(row[key] == value for key, value in swept.items() if key in row)


class Trial:
    """A row of results.csv, numbers as numbers, and what only results.json has."""

    def __init__(self, row, folder):
        self.row = row
        of_it = [file for file in folder.glob(f"**/seed_{int(row['seed']):04d}/results.json") if is_variant(file, row)]
        self.more = json.loads(of_it[0].read_text()) if of_it else {}

    def __getitem__(self, name):
        if name in self.row:
            return float(self.row[name])
        return float(self.more.get("more", self.more)[name])


def is_measured(name, seeds):
    """By the program and the scenario as they are now, all of it."""
    scenario, settings = STUDIES[name]
    table = OUT / name / "results.csv"
    newest = max(file.stat().st_mtime for file in (TRIAL, ROOT / "scenarios" / f"{scenario}.yaml"))
    if not table.exists() or table.stat().st_mtime < newest:
        return False
    variants = math.prod(len(setting.split("=", 1)[1].split()) for setting in settings)
    with open(table, newline="") as file:
        rows = list(csv.DictReader(file))
    return len(rows) == seeds * variants and {int(row["seed"]) for row in rows} == set(range(seeds))


def measure(name, seeds):
    scenario, settings = STUDIES[name]
    folder = OUT / name
    shutil.rmtree(folder, ignore_errors=True)
    command = [str(TRIAL), f"scenarios/{scenario}.yaml", "--out", str(folder), "--seeds", str(seeds), "--quiet"]
    for setting in settings:
        command += ["--set", setting]
    if name not in PROVED:
        command.append("--no-logs")
    done = subprocess.run(command, cwd=ROOT, check=False, stdout=subprocess.DEVNULL)
    if done.returncode not in (0, 1):
        sys.exit(f"results.py: {' '.join(command)}: status {done.returncode}")
    if name in PROVED:
        prove(folder)


def prove(folder):
    """Has each log of an automated laser checked, keeps what was found beside it, and not the log."""
    def check(log):
        if "aid=manual" not in str(log):
            subprocess.run([sys.executable, str(CHECK), str(log), "--json", str(log.with_name("checked.json"))], check=False,
                           stdout=subprocess.DEVNULL)
        log.unlink()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(check, folder.glob("**/trial.lcm")))


def proof(names):
    """Of all their pulses: how many, and how many broke which rule."""
    found = [log for name in names for file in sorted((OUT / name).glob("**/checked.json"))
             for log in json.loads(file.read_text())["logs"]]
    broken = {}
    for log in found:
        for rule in log["violations"]:
            broken[rule["rule"]] = broken.get(rule["rule"], 0) + rule["count"]
    return {"logs": len(found), "pulses": sum(len(log["pulses"]) for log in found), "broken": broken,
            **{key: sum(log[key] for log in found) for key in ("far", "far_unexplained", "interlock_violations")}}


def study(name, seeds):
    folder = OUT / name
    if not is_measured(name, seeds):
        measure(name, seeds)
    with open(folder / "results.csv", newline="") as file:
        return [Trial(row, folder) for row in csv.DictReader(file)]


def chosen(trials, aid, motion="in_situ"):
    return [trial for trial in trials if trial.row["aid"] == aid and trial.row["motion"] == motion]


def mean(trials, name):
    return statistics.fmean(trial[name] for trial in trials)


def spread(trials, name):
    return statistics.stdev(trial[name] for trial in trials) if len(trials) > 1 else 0.0


def of_seeds(trials, value):
    return {int(trial["seed"]): value(trial) for trial in trials}


def change(aided, bare, value):
    """Of the mean by the aid, per cent, with its 95 % interval: a percentile bootstrap over the seeds that both have."""
    with_aid, without = of_seeds(aided, value), of_seeds(bare, value)
    seeds = sorted(with_aid.keys() & without.keys())
    pairs = np.array([(with_aid[seed], without[seed]) for seed in seeds])
    drawn = pairs[np.random.default_rng(1).integers(0, len(seeds), (4000, len(seeds)))].mean(axis=1)
    low, high = np.percentile(100.0 * (drawn[:, 0] / drawn[:, 1] - 1.0), (2.5, 97.5))
    return 100.0 * (pairs[:, 0].mean() / pairs[:, 1].mean() - 1.0), low, high


def reduction(trials, aid, motion):
    value, low, high = change(chosen(trials, aid, motion), chosen(trials, "none", motion), lambda trial: trial["rms_um"])
    return f"{-value:.0f} % ({-high:.1f} to {-low:.1f})"


def rms(trials):
    return f"{mean(trials, 'rms_um'):.1f} ± {spread(trials, 'rms_um'):.1f}"


def errors(trials):
    return f"{rms(trials)} / {mean(trials, 'median_um'):.1f} / {mean(trials, 'p95_um'):.0f}"


def worse(trials):
    """Seeds in which an aid was worse than the bare hand by RMS or p95."""
    bare = {(trial.row["seed"], trial.row["motion"]): trial for trial in trials if trial.row["aid"] == "none"}
    aided = [trial for trial in trials if trial.row["aid"] != "none"]
    return sum(any(trial[name] > bare[trial.row["seed"], trial.row["motion"]][name] for name in ("rms_um", "p95_um"))
               for trial in aided), len(aided)


def tracing_rows(slow, fast):
    hard, soft = chosen(slow, "hard"), chosen(slow, "soft")
    yield "unaided, in situ", errors(chosen(slow, "none")), "162", ""
    yield ("hard, in situ 30/20, reduction", f"{errors(hard)}, {reduction(slow, 'hard', 'in_situ')}",
           "13.0 / 7.7 / 23, 92 %", "16 / 10 / 28, 88 %")
    yield ("soft, lambda 0.1, in situ 30/20, reduction", f"{errors(soft)}, {reduction(slow, 'soft', 'in_situ')}",
           "27.6, 83 %", "30, 80 %")
    fast_eye = chosen(slow, "hard", "jerky") + chosen(slow, "hard", "saccade")
    if fast_eye:
        yield ("hard, jerky / saccade: reduction (RMS)",
               " / ".join(f"{reduction(slow, 'hard', motion)}, {rms(chosen(slow, 'hard', motion))}"
                          for motion in ("jerky", "saccade")), "87 % / 73 %", "83 % / 65 %")
        yield ("outside 150 ms after fast motion: RMS / p99",
               f"{mean(fast_eye, 'calm_rms_um'):.1f} / {mean(fast_eye, 'calm_p99_um'):.0f}", "12.9 / 32", "15 / 40")
        yield ("the same, beside the path itself and not beyond its ends",
               f"{mean(fast_eye, 'calm_on_path_rms_um'):.1f} / {mean(fast_eye, 'calm_on_path_p99_um'):.0f}", "", "")
    if fast:
        yield ("hard, 120/5: in situ / jerky RMS",
               f"{rms(chosen(fast, 'hard'))} / {rms(chosen(fast, 'hard', 'jerky'))}",
               "10.0 / 11.0", "12 / 14")
    count, all_of_them = worse(slow + fast)
    yield "trials in which the aid is worse by RMS or p95", f"{count} of {all_of_them}", "", "0"
    yield "true vessel's whole path reached, mean share", f"{100.0 * mean(hard, 'path_coverage'):.0f} %", "", ""


def total(trials, name):
    return int(sum(trial[name] for trial in trials if trial.row[name]))


def touching(trials, calibre):
    return f"{total_of(trials, 'burns_on_vessels_' + calibre)} of {total(trials, 'fired')}"


def total_of(trials, name):
    return int(sum(trial.more.get("more", {}).get(name, 0) for trial in trials))


def coverage(trials, calibre):
    """Mean over the trials that had such a vessel in view."""
    shares = [trial.more.get("more", {}).get("map_coverage_" + calibre) for trial in trials]
    return statistics.fmean([share for share in shares if share is not None] or [0.0])


def far(trials):
    """With the share that may be true all the same, one-sided at 95 % (Clopper and Pearson)."""
    count, of = total(trials, "far_pulses"), total(trials, "fired")
    return f"{count} of {of} (at most {100.0 * beta.ppf(0.95, count + 1, max(of - count, 1)):.1f} %)"


def pulses_of(name, motion=""):
    """As the checker measured them, of all logs of a study of the automated laser."""
    return [pulse for file in sorted((OUT / name).glob("**/checked.json")) if motion in str(file)
            for log in json.loads(file.read_text())["logs"] for pulse in log["pulses"]]


def pooled_p95(name, motion=""):
    return np.percentile([pulse["placement_um"] for pulse in pulses_of(name, motion)] or [math.nan], 95)


def laser_rows(slow, fast):
    burnt = [trial for trial in slow + fast if trial.row["placement_mean_um"]]
    still, jerky = (chosen(burnt, "automated", motion) for motion in ("in_situ", "jerky"))
    still = [trial for trial in still if trial["camera_hz"] < 100]
    quick = [trial for trial in chosen(burnt, "automated") if trial["camera_hz"] > 100]
    manual = chosen(burnt, "manual")
    yield ("automated, in situ 30/20: mean ± spread / p95 of all pulses", f"{mean(still, 'placement_mean_um'):.1f} ± "
           f"{spread(still, 'placement_mean_um'):.1f} / {pooled_p95('laser', 'in_situ'):.0f}", "13.0 / 26", "16 / 32")
    if quick:
        yield ("automated, in situ 120/5: the same", f"{mean(quick, 'placement_mean_um'):.1f} ± "
               f"{spread(quick, 'placement_mean_um'):.1f} / {pooled_p95('laser_120'):.0f}", "10.0 / 21", "13 / 27")
    yield ("manual (a model fitted to nothing): mean / p95",
           f"{mean(manual, 'placement_mean_um'):.0f} / {mean(manual, 'placement_p95_um'):.0f}", "223 / 438", "")
    lower, faster = (change(still, manual, value) for value in
                     (lambda trial: trial["placement_mean_um"], lambda trial: 1.0 / trial["burns_per_s"]))
    yield ("error / time a burn against manual", " / ".join(f"{value:.0f} % ({low:.1f} to {high:.1f})"
                                                            for value, low, high in (lower, faster)),
           "-94 % / -73 %", "-88 % / -65 %")
    missed = [f"{total(group, 'missed')} of {total(group, 'fired')}" for group in (still, jerky, quick)]
    yield ("pulses that were stopped before their end (targets missed): in situ / jerky / 120/5", " / ".join(missed), "", "")
    yield ("pulses a second; of the manual operator",
           f"{mean(still, 'burns_per_s'):.2f}; {mean(manual, 'burns_per_s'):.2f}", "2.75; 0.74", "2.3")

    yield ("length of burns, drawn out by the spot's way: mean ± spread in a trial",
           f"{mean(still, 'burn_length_mean_um'):.0f} ± {mean(still, 'burn_length_spread_um'):.1f}", "", "")

    yield "pulses more than 60 um off: in situ / jerky", f"{far(still)} / {far(jerky)}", "0 / 1.4 %", "0.1 % / 2.5 %"
    proved = proof(PROVED)
    yield (f"by the checker, which shares no code with the servo, of {proved['pulses']} pulses in {proved['logs']} logs: "
           "far ones without a motion of 40 um", str(proved["far_unexplained"]), "0", "0")
    yield "pulses with an interlock open", str(proved["interlock_violations"]), "0", "0"
    yield ("pulses nearer to a vessel of the map than the margin",
           str(sum(proved["broken"].get(rule, 0) for rule in ("vessel_margin", "map_margin"))), "0", "0")
    others = {rule: count for rule, count in proved["broken"].items()
              if rule not in ("vessel_margin", "map_margin", "far_explained")}
    yield "any other of its rules broken", ", ".join(f"{rule} {n}" for rule, n in others.items()) or "0", "", "0"
    aided = still + jerky + quick
    yield "burns that touch a true vessel of 50 um or more", touching(aided, "50_um_or_more"), "", "0"
    for calibre, words in (("20_to_50_um", "20 to 50 um"), ("below_20_um", "below 20 um")):
        yield f"burns that touch one of {words}", touching(aided, calibre), "", ""
    yield ("the map has, of the area of true vessels of these calibres",
           " / ".join(f"{100.0 * coverage(aided, calibre):.0f} %" for calibre in CALIBRES), "", "")


def speed(name, settings=()):
    """How many times faster than real time one lock-step trial runs on one core, of all that it simulates."""
    folder = OUT / name
    command = [str(TRIAL), "scenarios/vessel_tracing.yaml", "--out", str(folder), "--jobs", "1", "--quiet", "--set", "aid=hard"]
    for setting in settings:
        command += ["--set", setting]
    subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    log, info = folder / "vessel_tracing" / "seed_0000" / "trial.lcm", folder / "info.json"
    subprocess.run([str(REPLAY), "info", str(log), "--quiet", "--json", str(info)], check=True)
    with open(folder / "results.csv", newline="") as file:
        wall_s = float(next(csv.DictReader(file))["wall_s"])
    return json.loads(info.read_text())["duration_s"] / wall_s


def speed_rows():
    yield ("a trial's simulated time, times its computation time on one core: 30 Hz, 800x608 / 120 Hz, 400x304",
           f"{speed('speed'):.1f} / {speed('speed_120', FAST):.1f}", "", "1.5 / 0.7")


def table(rows):
    return ["| what (um) | now | study | bound |", "| --- | --- | --- | --- |", *(f"| {' | '.join(row)} |" for row in rows)]


def trials(studies, seeds=20):
    yield "## Trials\n"
    yield "Whole trials in lock step on messages alone: rendered frames, the real tracker, its map, the servo, the simulated"
    yield f"surgeon, eye, Micron and laser; {seeds} seeds of 20 s (laser: until the plan is done), in vivo conditions, tremor of"
    yield "50 to 100 um RMS per axis. Errors are against the simulation's truth; of a tracing to the true centreline of its vessel,"
    yield "beyond the ends of its path to that of any vessel. ± is the spread over seeds, of burns' lengths that within a trial;"
    yield "in parentheses the 95 % interval of a percentile bootstrap over seeds. Medians and p95 of tracings are means over seeds."
    yield "The studies:\n"
    yield "```text"
    for name in studies:
        scenario, settings = STUDIES[name]
        logs = "" if name in PROVED else " --no-logs"
        yield f"eyeslam-trial scenarios/{scenario}.yaml --seeds {seeds}{logs} " + " ".join(f"--set '{s}'" for s in settings)
    yield "```\n"
    done = {name: study(name, seeds) for name in studies}

    def of(*names):
        return [trial for name in names for trial in done.get(name, [])]

    yield from table(tracing_rows(of("tracing", "tracing_soft", "tracing_eye"), of("tracing_120")))
    yield ""
    yield from table(laser_rows(of("laser"), of("laser_120")))
    yield "\nThe speed, on this machine as busy as it was: `eyeslam-trial scenarios/vessel_tracing.yaml --set aid=hard --jobs 1`, its"
    yield "`wall_s` beside the `duration_s` of its log by `eyeslam-replay info`.\n"
    yield from table(speed_rows())

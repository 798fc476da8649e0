# SPDX-License-Identifier: GPL-3.0-or-later
"""What a log must be before it proves anything: whole, of known types, in order, with the truth in each millisecond."""
import numpy as np

from trial_log.trial_log import OTHER_CLOCK_us

LONGEST_GAP_us = 2500  # between two TRUTH, which come each millisecond


def check(log, findings):
    _whole(log, findings)
    for channel, time, text in log.strangers:
        findings.add("message_type", log.seconds(time), f"{channel}: {text}")
    _truth(log, findings)
    for name, channel in log.channels.items():
        _senders(log, findings, name, channel)
    for name in ("MICRON_COMMAND", "LASER_COMMAND"):
        _numbers(log, findings, name)
        _images(log, findings, name)


def _whole(log, findings):
    if log.events.damage():
        findings.add("whole_log", 0.0, log.events.damage())
    logged = np.concatenate([channel.logged for channel in log.channels.values()])
    place = np.concatenate([channel.place for channel in log.channels.values()])
    logged = logged[np.argsort(place)]
    back = np.flatnonzero(np.diff(logged) < 0)
    findings.add_all("whole_log", log, logged[back], lambda i: "the log's time goes back")


def _truth(log, findings):
    time = log.truth.time
    if not len(time):
        return findings.add("truth_complete", 0.0, "there is no TRUTH")
    late = np.flatnonzero(np.diff(time) > LONGEST_GAP_us)
    findings.add_all("truth_complete", log, time[late], lambda i: f"nothing for {(time[late[i] + 1] - time[late[i]]) / 1e3:g} ms")


def _groups(name, channel):
    """Indices of each sender's messages as they were logged. A plan has two senders, a mark any."""
    kind = {"BURN_PLAN": "state", "MARK": "sender"}.get(name)
    keys = [(session, channel[kind][i] if kind else 0) for i, session in enumerate(channel["session"])]
    logged = np.argsort(channel.place)
    for key in dict.fromkeys(keys):
        if len(set(keys)) == 1:
            yield logged
        else:
            yield np.array([i for i in logged if keys[i] == key])


def _senders(log, findings, name, channel):
    """Where the trial sets the hardware's clock, as its fault says, a second there and back is no message out of order."""
    if not len(channel):
        return
    set_back = log.settings.get("fault.kind") == "clock_step" and name in ("MICRON_STATE", "LASER_STATE")
    sent, seq = np.asarray(channel["utime_sent"]), np.asarray(channel["seq"])
    for group in _groups(name, channel):
        step = np.diff(sent[group])
        back = np.flatnonzero(((step < 0) & ~(set_back & (step < -OTHER_CLOCK_us))) | (np.diff(seq[group]) <= 0))
        findings.add_all("sender_time", log, channel.time[group[back + 1]],
                         lambda i, g=group, b=back: f"{name} {seq[g[b[i] + 1]]} after {seq[g[b[i]]]}")
    later = np.flatnonzero(np.asarray(channel["utime"]) > sent)
    findings.add_all("sender_time", log, channel.time[later],
                     lambda i: f"{name} {seq[later[i]]} tells of a time after it was sent")


def _numbers(log, findings, name):
    channel = log.channels[name]
    if not len(channel):
        return
    seq = channel["seq"]
    for group in _groups(name, channel):
        gap = np.flatnonzero(np.diff(seq[group]) > 1)
        findings.add_all("command_numbers", log, channel.time[group[gap + 1]],
                         lambda i, g=group, b=gap: f"{name} {seq[g[b[i] + 1]]} after {seq[g[b[i]]]}")


def _images(log, findings, name):
    """A frame is known by the time of its exposure's middle, from the moment when its pose was sent."""
    commands = log.channels[name]
    used = np.flatnonzero(commands["utime_image"] != 0)
    order = np.argsort(log.retina_pose["utime"], kind="stable")
    frames, ranks = log.retina_pose["utime"][order], log.retina_pose.rank[order]
    image = commands["utime_image"][used]
    at = np.searchsorted(frames, image)
    known = np.zeros(len(used), dtype=bool)
    inside = at < len(frames)
    known[inside] = (frames[at[inside]] == image[inside]) & (ranks[at[inside]] < commands.rank[used[inside]])
    bad = used[~known | (image > commands["utime_sent"][used])]
    findings.add_all("image_time", log, commands.time[bad],
                     lambda i: f"{name} {commands['seq'][bad[i]]} is of a frame that nobody knew of")

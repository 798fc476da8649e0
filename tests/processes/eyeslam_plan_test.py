# SPDX-License-Identifier: GPL-3.0-or-later
"""eyeslam-plan on good and on bad input: eyeslam_plan_test.py PLAN TRACK SIM [unittest arguments]."""
import math
import os
import shutil
import unittest
import xml.etree.ElementTree

import cv2
import numpy as np

from plan_case import PLAN, UM_PER_PX, PlanCase, tracked


def valid(plan):
    return [target for target in plan["targets"] if target["valid"]]


class GoodInput(PlanCase):
    def test_the_folder_alone_gives_rings_and_says_first_what_is_unknown(self):
        plan, summary = self.plan()
        self.assertEqual(len(plan["targets"]), 32)
        self.assertGreater(len(valid(plan)), 0)
        self.assertEqual(plan["um_per_px"], UM_PER_PX)
        lines = summary.splitlines()
        self.assertTrue(lines[0].startswith("warning: fovea unknown") and lines[1].startswith("warning: optic disc"), summary)
        for word in ("valid", "refused", "density", "clearance", "travel", "placement", "written"):
            self.assertIn(word, summary)

    def test_a_known_fovea_and_disc_are_kept_free_and_need_no_warning(self):
        plan, summary = self.plan("--pattern", "hexagonal", "--spacing-um", "300", "--fovea", "400,300", "--disc", "650,300")
        self.assertNotIn("unknown", summary)
        self.assertGreater(len(valid(plan)), 0)
        for target in valid(plan):
            free_um = UM_PER_PX * math.hypot(target["x_px"] - 400, target["y_px"] - 300)
            self.assertGreater(free_um, 500 + target["burn_um"] / 2)

    def test_no_burn_comes_near_a_vessel_of_the_map(self):
        plan, _ = self.plan("--pattern", "hexagonal", "--spacing-um", "250")
        name = self.newest_map()
        vessels = cv2.imread(os.path.join(self.dir, "map", name), cv2.IMREAD_UNCHANGED) >= 128
        geometry = self.read("out/map/" + name.replace(".png", ".json"))
        distance = cv2.distanceTransform(np.uint8(~vessels), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
        for target in valid(plan):
            column = round((target["x_px"] - geometry["origin_x"]) / geometry["px_per_cell"])
            row = round((target["y_px"] - geometry["origin_y"]) / geometry["px_per_cell"])
            # Rounding to a cell moves the middle by at most its half diagonal; the other cell's half is the vessel's.
            free_um = (distance[row, column] + 0.71) * geometry["px_per_cell"] * UM_PER_PX
            self.assertGreater(free_um, target["burn_um"] / 2 + plan["margin_um"])

    def test_targets_stand_in_the_order_of_execution_and_refused_ones_last(self):
        plan, _ = self.plan("--pattern", "hexagonal", "--set", "order.reach_um=1500")
        flags = [target["valid"] for target in plan["targets"]]
        self.assertEqual(flags, sorted(flags, reverse=True))
        tiles = [target["tile"] for target in valid(plan)]
        self.assertEqual(tiles, sorted(tiles))
        self.assertEqual(set(tiles), set(range(max(tiles) + 1)))
        for tile in set(tiles):
            places = np.array([(t["x_px"], t["y_px"]) for t in valid(plan) if t["tile"] == tile], np.float32)
            self.assertLess(2 * UM_PER_PX * cv2.minEnclosingCircle(places)[1], 1500 + 1)

    def test_the_same_call_gives_the_same_bytes(self):
        files = []
        for run in ("a", "b"):
            self.plan("--pattern", "hexagonal", "--svg", self.path(run + ".svg"), "--png", self.path(run + ".png"), "--travel")
            for name in ("out/plan.json", run + ".svg", run + ".png"):
                with open(self.path(name), "rb") as file:
                    files.append(file.read())
        self.assertEqual(files[:3], files[3:])

    def test_yaml_options_and_set_say_the_same(self):
        self.plan("--pattern", "hexagonal", "--spacing-um", "350", "--spot-um", "120", "--margin-um", "90")
        first = self.read("out/plan.json")
        yaml = self.write("my.yaml", "pattern:\n  kind: hexagonal\n  spacing_um: 350\nlaser:\n  spot_um: 120\n")
        self.plan("--prescription", yaml, "--set", "safety.margin_um=90")
        self.assertEqual(self.read("out/plan.json"), first)

    def test_the_printed_prescription_is_the_default(self):
        first, _ = self.plan()
        printed = self.run_plan("--dump-config")
        self.assertEqual(printed.returncode, 0, printed.stderr)
        self.plan("--prescription", self.write("all.yaml", printed.stdout))
        self.assertEqual(self.read("out/plan.json"), first)

    def test_the_page_of_keys_is_what_the_program_prints(self):
        with open(os.path.join(os.path.dirname(__file__), "../../docs/prescription.md")) as page:
            self.assertEqual(self.run_plan("--dump-config=markdown").stdout, page.read(),
                             "eyeslam-plan --dump-config=markdown > docs/prescription.md")

    def test_quiet_prints_nothing(self):
        self.assertEqual(self.plan("--quiet")[1], "")


class Drawings(PlanCase):
    def burn_colours(self, plan, picture):
        """Brightness in the middle of each target, of a drawing over the map: what was seen, and 8 cells around it."""
        geometry = self.read("out/map/" + self.newest_map().replace(".png", ".json"))
        seen = cv2.imread(os.path.join(self.dir, "map", self.newest_map().replace("map", "seen")), cv2.IMREAD_UNCHANGED)
        left, top, width, _ = cv2.boundingRect(seen)
        first, last = max(left - 8, 0), min(left + width + 8, seen.shape[1])
        scale = picture.shape[1] / ((last - first) * geometry["px_per_cell"])
        for target in plan["targets"]:
            x, y = (((target[key] - geometry[origin]) / geometry["px_per_cell"] - corner + 0.5) * geometry["px_per_cell"] * scale - 0.5
                    for key, origin, corner in (("x_px", "origin_x", first), ("y_px", "origin_y", max(top - 8, 0))))
            if 0 <= y < picture.shape[0] and 0 <= x < picture.shape[1]:
                yield target, int(picture[round(y), round(x)].mean())

    def test_valid_burns_are_white_and_refused_ones_black(self):
        plan, _ = self.plan("--pattern", "hexagonal", "--set", "order.reach_um=50000", "--png", self.path("plan.png"))
        seen = list(self.burn_colours(plan, cv2.imread(self.path("plan.png"))))
        self.assertGreater(len(seen), 0.9 * len(plan["targets"]))
        for target, brightness in seen:
            self.assertEqual(brightness, 255 if target["valid"] else 0, target)

    def test_the_svg_is_one_file_with_a_disc_a_target(self):
        plan, _ = self.plan("--svg", self.path("plan.svg"), "--over", "mosaic", "--travel")
        root = xml.etree.ElementTree.parse(self.path("plan.svg")).getroot()
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        text = xml.etree.ElementTree.tostring(root, encoding="unicode")
        self.assertNotIn("file:", text)
        self.assertGreaterEqual(text.count('fill="#ffffff"'), len(valid(plan)))

    def test_over_a_photograph_in_map_px(self):
        photograph = np.full((608, 800, 3), 90, np.uint8)
        cv2.imwrite(self.path("retina.png"), photograph)
        self.plan("--png", self.path("plan.png"), "--over", self.path("retina.png"))
        self.assertEqual(cv2.imread(self.path("plan.png"))[2, 2].tolist(), [90, 90, 90])

    def test_a_picture_that_cannot_lie_under_it_is_refused(self):
        cv2.imwrite(self.path("small.png"), np.zeros((4, 4, 3), np.uint8))
        self.write("notes.png", "no picture")
        for name in ("small.png", "notes.png", "gone.png"):
            self.assert_refused_and_nothing_written(
                [self.dir, "--png", self.path("plan.png"), "--over", self.path(name)], name)

    def test_a_drawing_that_cannot_be_written_leaves_no_plan(self):
        self.assert_refused_and_nothing_written([self.dir, "--svg", self.path("gone/plan.svg")], "gone/plan.svg", status=(1,))
        self.assert_refused_and_nothing_written([self.dir, "--svg", self.path("plan.png")], "--svg", status=(2,))


class Check(PlanCase):
    def test_a_plan_holds_on_its_own_map(self):
        self.plan("--pattern", "hexagonal")
        process = self.run_plan("--check", self.path("out/plan.json"), self.dir)
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertIn("the plan's own", process.stdout)

    def test_targets_under_a_new_vessel_are_named_and_the_status_is_1(self):
        plan, _ = self.plan("--pattern", "hexagonal")
        victim = valid(plan)[3]
        name = os.path.join(self.dir, "map", self.newest_map())
        geometry = self.read("out/map/" + self.newest_map().replace(".png", ".json"))
        cells = cv2.imread(name, cv2.IMREAD_UNCHANGED)
        column, row = (round((victim[key] - geometry[origin]) / geometry["px_per_cell"])
                       for key, origin in (("x_px", "origin_x"), ("y_px", "origin_y")))
        cells[row, column] = 255
        cv2.imwrite(name, cells)
        os.remove(os.path.join(self.dir, "vessels.csv"))
        process = self.run_plan("--check", self.path("out/plan.json"), self.dir, "--out", self.path("renewed.json"))
        self.assert_refused(process, "became invalid", str(victim["id"]), status=(1,))
        self.assertIn(f"invalid    {victim['id']} at", process.stdout)
        self.assertIn("near_vessel", process.stdout)
        renewed = {target["id"]: target for target in self.read("renewed.json")["targets"]}
        self.assertEqual(renewed[victim["id"]]["reason"], "near_vessel")

    def test_a_plan_of_another_track_is_refused(self):
        self.plan()
        before = self.files()
        self.assert_refused(self.run_plan("--check", self.path("out/plan.json"), tracked(5)), "plan.json", "track", status=(1,))
        self.assertEqual(self.files(), before)

    def test_a_scale_that_differs_is_refused(self):
        self.plan()
        process = self.run_plan("--check", self.path("out/plan.json"), self.dir, "--um-per-px", str(1.04 * UM_PER_PX))
        self.assert_refused(process, "um_per_px", "3 %")

    def test_truncated_and_foreign_plans_are_refused(self):
        self.plan()
        with open(self.path("out/plan.json")) as file:
            text = file.read()
        for name, content in (("cut.json", text[:len(text) // 2]), ("run.json", '{"version": "0.1.0"}'), ("list.json", "[]"),
                              ("empty.json", ""), ("nan.json", text.replace('"x_px": ', '"x_px": NaN, "y": ', 1))):
            self.assert_refused_and_nothing_written(["--check", self.write(name, content), self.dir], name, status=(1,))
        for key in ("um_per_px", "map", "targets", "prescription"):
            self.write("lacks.json", text)
            self.edit_json("lacks.json", lambda plan: plan.pop(key))
            self.assert_refused(self.run_plan("--check", self.path("lacks.json"), self.dir), "lacks.json", status=(1,))

    def test_a_prescription_beside_check_is_refused(self):
        self.assert_refused(self.run_plan("--check", "plan.json", self.dir, "--spot-um", "50"), "--check", status=(2,))


class BadPrescription(PlanCase):
    def refuse(self, *arguments, named):
        self.assert_refused_and_nothing_written([self.dir, *arguments], *named)

    def test_spacing(self):
        for spacing in ("0", "-100", "99", "nan", "wide"):
            self.refuse("--set", f"pattern.spacing_um={spacing}", named=["pattern.spacing_um"])

    def test_polygons(self):
        polygon = ["--pattern", "hexagonal", "--set", "pattern.region=polygon", "--set"]
        self.refuse(*polygon, "pattern.points_px=200,200 400,400 400,200 200,400", named=["pattern.points_px", "crosses"])
        self.refuse(*polygon, "pattern.points_px=200,200 99999,200 300,400", named=["pattern.points_px", "outside"])
        self.refuse(*polygon, "pattern.points_px=200,200 400,400", named=["pattern.points_px"])
        self.refuse("--set", "keep_out.polygons_px=200,200 400,400 400,200 200,400", named=["keep_out.polygons_px"])

    def test_keys_and_files(self):
        self.refuse("--set", "pattern.spaceing_um=300", named=["pattern.spaceing_um", "pattern.spacing_um"])
        self.refuse("--pattern", "stars", named=["pattern.kind", "hexagonal"])
        self.refuse("--prescription", self.path("gone.yaml"), named=["gone.yaml"])
        self.refuse("--prescription", self.write("bad.yaml", "pattern: {kind: rings\n"), named=["bad.yaml"])
        self.refuse("--start", "here", named=["order.start_px"])

    def test_scale(self):
        for value in ("0", "-1", "nan", "0.0001", "9999"):
            self.refuse("--um-per-px", value, named=["um"])
        self.edit_json("out/map/" + self.newest_map().replace(".png", ".json"), lambda place: place.update(um_per_px=None))
        self.refuse(named=["um_per_px", "--um-per-px"])
        self.assertEqual(self.run_plan(self.dir, "--um-per-px", "5").returncode, 0)


class BadMap(PlanCase):
    def refuse(self, *named, status=(1,)):
        self.assert_refused_and_nothing_written([self.dir], *named, status=status)

    def test_a_folder_that_is_none_of_the_trackers(self):
        os.mkdir(self.path("bare"))
        self.assert_refused(self.run_plan(self.path("bare")), "bare", status=(1,))
        self.assert_refused(self.run_plan(self.path("gone")), "gone", status=(1,))
        self.assert_refused(self.run_plan(), "DIR", status=(2,))

    def test_truncated_files(self):
        for name in (self.newest_map(), self.newest_map().replace(".png", ".json"), self.newest_map().replace("map", "seen")):
            path = os.path.join(self.dir, "map", name)
            shutil.copy(path, self.path("whole"))
            with open(path, "r+b") as file:
                file.truncate(os.path.getsize(path) // 2)
            self.refuse(name)
            shutil.move(self.path("whole"), path)

    def test_a_map_without_what_was_seen(self):
        name = self.newest_map().replace("map", "seen")
        os.remove(os.path.join(self.dir, "map", name))
        self.refuse(name)

    def test_scale_that_is_absurd(self):
        for value in (-5.0, 0.0, "wide", 4000.0):
            self.edit_json("out/map/" + self.newest_map().replace(".png", ".json"), lambda place: place.update(um_per_px=value))
            self.refuse("um_per_px", status=(1, 2))

    def test_a_frame_that_was_not_kept(self):
        self.assert_refused(self.run_plan(self.dir, "--frame", "7"), "7", status=(1, 2))
        self.assertEqual(self.run_plan(self.dir, "--frame", "19").returncode, 0)


if __name__ == "__main__":
    unittest.main()

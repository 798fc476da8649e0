// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/prescription_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eyeslam/files/whole_file.h"
#include "support/temporary_folder.h"

namespace eyeslam::files {
namespace {

using configuration::ConfigurationError;
using ::testing::HasSubstr;

class PrescriptionFile : public ::testing::Test {
 protected:
  fixtures::BurnPrescription read(const std::string& yaml, const std::vector<std::string>& settings = {}) const
  {
    writeWholeFile(folder_.path("p.yaml"), yaml);
    return readPrescription(folder_.path("p.yaml"), settings);
  }
  void expectRefused(const std::string& yaml, const std::string& part) const
  {
    try {
      read(yaml);
      ADD_FAILURE() << yaml;
    } catch (const ConfigurationError& error) {
      EXPECT_THAT(error.what(), HasSubstr("p.yaml"));
      EXPECT_THAT(error.what(), HasSubstr(part));
    }
  }

  support::TemporaryFolder folder_;
};

TEST_F(PrescriptionFile, ReadsGroupsAndLists)
{
  const auto prescription = read(
      "pattern:\n  kind: hexagonal\n  region: polygon\n  points_px: [[10, 20], [300.5, 40], [100, 200]]\n"
      "  counts: [5, 11, 16]\nlaser:\n  spot_um: 200\nkeep_out:\n"
      "  polygons_px: [[[1, 2], [3, 4], [1, 4]], [[5, 6], [7, 8], [5, 8]]]\n");
  EXPECT_EQ(prescription.pattern.points_px, "10 20 300.5 40 100 200");
  EXPECT_EQ(prescription.pattern.counts, "5 11 16");
  EXPECT_EQ(prescription.laser.spot_um, 200.0);
  EXPECT_EQ(fixtures::polygonsIn("polygons", prescription.keep_out.polygons_px).size(), 2U);
  EXPECT_EQ(prescription.pattern.spacing_um, 600.0) << "what is not said keeps its default";
}

TEST_F(PrescriptionFile, SettingsGoOverTheFile)
{
  const auto prescription = read("pattern:\n  kind: grid\n  spacing_um: 300\n", {"pattern.spacing_um=400"});
  EXPECT_EQ(prescription.pattern.kind, "grid");
  EXPECT_EQ(prescription.pattern.spacing_um, 400.0);
  EXPECT_EQ(readPrescription("", {"pattern.kind=spots", "pattern.points_px=5,6"}).pattern.points_px, "5,6");
}

TEST_F(PrescriptionFile, ReadsBackWhatItLists)
{
  auto prescription = readPrescription("", {"pattern.kind=macular", "keep_out.fovea_px=5 6", "safety.margin_um=33.5"});
  const std::string yaml = prescriptionYaml(prescription);
  EXPECT_EQ(prescriptionYaml(read(yaml)), yaml);
}

TEST_F(PrescriptionFile, NamesWhatIsWrong)
{
  expectRefused("pattern:\n  spaceing_um: 300\n", "pattern.spaceing_um");
  expectRefused("patterns:\n  spacing_um: 300\n", "patterns.spacing_um");
  expectRefused("pattern:\n  spacing_um: 300\n  spacing_um: 400\n", "pattern.spacing_um' stands twice");
  expectRefused("pattern:\n  spacing_um: wide\n", "pattern.spacing_um");
  expectRefused("pattern:\n  side: 2.5\n", "pattern.side");
  expectRefused("pattern:\n  side: 9\n", "pattern.side");
  expectRefused("pattern:\n  kind: star\n", "pattern.kind");
  expectRefused("pattern:\n  spacing_um: 0\n", "pattern.spacing_um");
  expectRefused("pattern:\n  spacing_um: -5\n", "pattern.spacing_um");
  expectRefused("pattern:\n  spacing_um: 50\n", "pattern.spacing_um");
  expectRefused("laser:\n  spot_um: .nan\n", "laser.spot_um");
  expectRefused("keep_out:\n  polygons_px: [[0, 0], [10, 10], [10, 0], [0, 10]]\n", "keep_out.polygons_px");
  expectRefused("pattern:\n  points_px: [[1, 2], {x: 3}]\n", "pattern.points_px");
  expectRefused("pattern:\n  points_px: [[[[1, 2]]]]\n", "pattern.points_px");
  expectRefused("pattern: &a [*a]\n", "pattern");
  expectRefused("just words\n", "key: value");
}

}  // namespace
}  // namespace eyeslam::files

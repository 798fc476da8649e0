// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/prescription_file.h"

#include "eyeslam/configuration/listing.h"

namespace eyeslam::files {

fixtures::BurnPrescription readPrescription(const std::string& path, const std::vector<std::string>& settings)
{
  namespace conf = eyeslam::configuration;
  std::vector<conf::Assignment> assignments;
  if (!path.empty()) assignments = conf::readYaml(path, conf::YamlLists::joined);
  for (const std::string& setting : settings) assignments.push_back(conf::parseSetting(setting));
  auto prescription = conf::applied(fixtures::BurnPrescription(), assignments);
  try {
    fixtures::check(prescription);
  } catch (const fixtures::PlanError& error) {
    throw conf::ConfigurationError((path.empty() ? "prescription" : path) + ": " + error.what());
  }
  return prescription;
}

std::string prescriptionYaml(const fixtures::BurnPrescription& prescription)
{
  return configuration::yamlOf(prescription);
}

}  // namespace eyeslam::files

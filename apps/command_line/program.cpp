// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/program.h"

#include <fmt/format.h>
#include <omp.h>
#include <signal.h>

#include <cstdio>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>

#include "command_line/version.h"
#include "eyeslam/configuration/assignment.h"

namespace eyeslam::apps {
namespace {

constexpr int kFailed = 1;
constexpr int kWrongCall = 2;

void silenceLibraries()
{
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);  // AV_LOG_QUIET; OpenCV has no call for it
  // An OpenCV error comes back as an exception; its printout would be a second line.
  cv::redirectError([](int, const char*, const char*, const char*, int, void*) { return 0; });
}

// ViSP's threads spin while they wait, and a small picture is done before they have started.
void useOneThread()
{
  omp_set_num_threads(1);
  cv::setNumThreads(1);
}

int complain(const char* name, const char* what, int status) noexcept
{
  std::fprintf(stderr, "%s: ", name);
  for (const char* letter = what; *letter != 0; ++letter) std::fputc(*letter == '\n' ? ' ' : *letter, stderr);
  std::fputc('\n', stderr);
  return status;
}

int parseAndRun(CLI::App& app, int argc, char** argv, const ProgramSetup& setUp)
{
  const std::function<void()> run = setUp(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    throw UsageError(fmt::format("{}; {} --help lists all options", error.what(), app.get_name()));
  }
  run();
  return 0;
}

}  // namespace

void addStandardOptions(CLI::App& app, const std::string& examples)
{
  app.set_help_flag("-h,--help", "Print this and exit");
  app.set_version_flag("--version", fmt::format("{} {}", app.get_name(), kVersion), "Print the version and exit");
  app.get_formatter()->column_width(34);
  app.footer("Examples:\n" + examples + "\nExit status: 0 done, 1 the work failed, 2 the call was wrong.");
}

int runProgram(const char* name, const char* about, int argc, char** argv, const ProgramSetup& setUp) noexcept
{
  try {
    silenceLibraries();
    useOneThread();
    signal(SIGXFSZ, SIG_IGN);  // a file too large for the limit is then an error like a full disk
    CLI::App app(about, name);
    return parseAndRun(app, argc, argv, setUp);
  } catch (const UsageError& error) {
    return complain(name, error.what(), kWrongCall);
  } catch (const configuration::ConfigurationError& error) {
    return complain(name, error.what(), kWrongCall);
  } catch (const std::exception& error) {
    return complain(name, error.what(), kFailed);
  } catch (...) {
    return complain(name, "failed without saying why", kFailed);
  }
}

}  // namespace eyeslam::apps

// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/program.h"

#include <fmt/format.h>
#include <omp.h>
#include <signal.h>

#include <algorithm>
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

int complain(const CLI::App& app, const std::string& what, int status)
{
  std::string line = what;
  std::replace(line.begin(), line.end(), '\n', ' ');
  fmt::print(stderr, "{}: {}\n", app.get_name(), line);
  return status;
}

}  // namespace

void addStandardOptions(CLI::App& app, const std::string& examples)
{
  app.set_help_flag("-h,--help", "Print this and exit");
  app.set_version_flag("--version", fmt::format("{} {}", app.get_name(), kVersion), "Print the version and exit");
  app.get_formatter()->column_width(34);
  app.footer("Examples:\n" + examples + "\nExit status: 0 done, 1 the work failed, 2 the call was wrong.");
}

int runProgram(CLI::App& app, int argc, char** argv, const std::function<void()>& run)
{
  silenceLibraries();
  useOneThread();
  signal(SIGXFSZ, SIG_IGN);  // a file too large for the limit is then an error like a full disk
  try {
    app.parse(argc, argv);
    run();
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return complain(app, fmt::format("{}; {} --help lists all options", error.what(), app.get_name()), kWrongCall);
  } catch (const UsageError& error) {
    return complain(app, error.what(), kWrongCall);
  } catch (const configuration::ConfigurationError& error) {
    return complain(app, error.what(), kWrongCall);
  } catch (const std::exception& error) {
    return complain(app, error.what(), kFailed);
  }
}

}  // namespace eyeslam::apps

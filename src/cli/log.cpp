// SPDX-License-Identifier: Apache-2.0
// spdlog on stderr.
#include <unistd.h>

#include <cstdlib>
#include <string_view>

#include <spdlog/sinks/stdout_color_sinks.h>

#include <dpchip/cli/log.hpp>

namespace dpchip::cli {

bool is_terminal(int fd) { return ::isatty(fd) == 1; }

bool may_colour(int fd) {
    const char* no_color = std::getenv("NO_COLOR");
    const char* term = std::getenv("TERM");
    const bool dumb = term == nullptr || std::string_view{term} == "dumb";
    return is_terminal(fd) && !dumb && (no_color == nullptr || *no_color == '\0');
}

void start_log(Loudness loudness) {
    const auto mode = may_colour(STDERR_FILENO) ? spdlog::color_mode::always : spdlog::color_mode::never;
    auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_st>(mode);
    auto logger = std::make_shared<spdlog::logger>("dpchip", std::move(sink));
    logger->set_pattern("dpchip: %^%l%$: %v");
    logger->set_level(loudness == Loudness::quiet     ? spdlog::level::err
                      : loudness == Loudness::verbose ? spdlog::level::debug
                                                      : spdlog::level::info);
    spdlog::set_default_logger(std::move(logger));
}

}  // namespace dpchip::cli

// SPDX-License-Identifier: Apache-2.0
// Terminal control: cursor up, erase line; nothing else.
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include <dpchip/cli/live_view.hpp>
#include <dpchip/cli/log.hpp>

namespace dpchip::cli {
namespace {

/// Characters, not octets.
std::size_t width(const std::string& utf8) {
    return static_cast<std::size_t>(std::count_if(utf8.begin(), utf8.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

/// The first `limit` characters.
std::string cut(const std::string& utf8, std::size_t limit) {
    std::size_t at = 0;
    for (std::size_t n = 0; at < utf8.size(); ++at)
        if ((static_cast<unsigned char>(utf8[at]) & 0xC0u) != 0x80u && n++ == limit) break;
    return utf8.substr(0, at);
}

struct Size {
    std::size_t rows = 24, columns = 80;
};
Size terminal_size() {
    winsize w{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &w) != 0 || w.ws_row == 0 || w.ws_col == 0) return {};
    return {w.ws_row, w.ws_col};
}

}  // namespace

std::vector<std::string> align(const Rows& rows) {
    std::vector<std::size_t> widths;
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (i == widths.size()) widths.push_back(0);
            widths[i] = std::max(widths[i], width(row[i]));
        }
    std::vector<std::string> lines;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            line += row[i];
            if (i + 1 < row.size()) line.append(widths[i] - width(row[i]) + 2, ' ');
        }
        while (!line.empty() && line.back() == ' ') line.pop_back();
        lines.push_back(std::move(line));
    }
    return lines;
}

void print(const Rows& rows) {
    for (const std::string& line : align(rows)) std::printf("%s\n", line.c_str());
    std::fflush(stdout);
}

LiveView::LiveView() : active_{is_terminal(STDOUT_FILENO)}, colour_{may_colour(STDOUT_FILENO)} {}

void LiveView::draw(const Rows& rows) {
    if (!active_) return;
    const Size size = terminal_size();
    clear();
    for (const std::string& line : align(rows)) {
        if (drawn_ + 2 >= size.rows) break;
        const bool head = drawn_ == 0 && colour_;
        std::printf("%s%s%s\n", head ? "\x1b[1m" : "", cut(line, size.columns - 1).c_str(), head ? "\x1b[0m" : "");
        ++drawn_;
    }
    std::fflush(stdout);
}

void LiveView::clear() {
    if (!active_ || drawn_ == 0) return;
    std::printf("\x1b[%zuA\x1b[J", drawn_);
    std::fflush(stdout);
    drawn_ = 0;
}

}  // namespace dpchip::cli

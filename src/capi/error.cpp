// SPDX-License-Identifier: Apache-2.0
// dpchip_last_error() and dpchip_version().
#include "error.hpp"

namespace dpchip::capi {

namespace {
std::string& last_error() {
    thread_local std::string words;
    return words;
}
}  // namespace

int fail(int code, const std::string& words) {
    last_error() = words;
    return code;
}

}  // namespace dpchip::capi

const char* dpchip_last_error(void) { return dpchip::capi::last_error().c_str(); }

const char* dpchip_version(void) { return DPCHIP_VERSION; }

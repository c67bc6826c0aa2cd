// SPDX-License-Identifier: Apache-2.0
// The last error of a thread, and the wall that no exception gets over.
#pragma once

#include <exception>
#include <new>
#include <string>

#include <dpchip/dpchip.h>
#include <dpchip/live/line_error.hpp>

namespace dpchip::capi {

/// Remembers `words` for dpchip_last_error() and returns `code`.
int fail(int code, const std::string& words);

/// Runs `body`; whatever it throws becomes a code with words. `otherwise` turns the code into the function's own result.
template <class Body, class Otherwise>
auto guarded(Body&& body, Otherwise&& otherwise) noexcept -> decltype(body()) {
    try {
        return body();
    } catch (const live::LineError& e) {
        return otherwise(fail(DPCHIP_E_LINE, e.what()));
    } catch (const std::bad_alloc&) {
        return otherwise(fail(DPCHIP_E_MEMORY, "out of memory"));
    } catch (const std::exception& e) {
        return otherwise(fail(DPCHIP_E_INTERNAL, e.what()));
    } catch (...) {
        return otherwise(fail(DPCHIP_E_INTERNAL, "unknown error"));
    }
}

/// The usual case: the code is the result.
template <class Body>
auto guarded(Body&& body) noexcept -> decltype(body()) {
    return guarded(body, [](int code) { return static_cast<decltype(body())>(code); });
}

}  // namespace dpchip::capi

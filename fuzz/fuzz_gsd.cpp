// SPDX-License-Identifier: Apache-2.0
// Any octets as a GSD file: parse, plug what can be plugged, build and check its parameters, render everything.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <dpchip/gsd/configuration.hpp>
#include <dpchip/gsd/describe.hpp>
#include <dpchip/gsd/parse.hpp>
#include <dpchip/gsd/user_prm.hpp>

namespace gsd = dpchip::gsd;

namespace {

void use(const gsd::Gsd& g) {
    static_cast<void>(gsd::describe(g) + gsd::describe_modules(g));
    static_cast<void>(gsd::describe_keywords(g, gsd::KeywordChoice::all));
    gsd::Configuration c;
    try {
        c = gsd::configure(g);
    } catch (const gsd::GsdError&) {
        try {
            c = gsd::configure_modules(g, {0});
        } catch (const gsd::GsdError&) { return; }
    }
    try {
        const gsd::UserPrmData data = gsd::user_prm_data(g, c);
        static_cast<void>(gsd::describe_parameters(g, data));
        // What the station proposes it must take.
        if (gsd::check_user_prm(g, data, data.octets)) std::abort();
        static_cast<void>(gsd::diag_texts(g, data.octets));
    } catch (const gsd::GsdError&) {}
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text{reinterpret_cast<const char*>(data), size};
    const gsd::Parsed parsed = gsd::parse(text, "fuzz");
    for (const gsd::Diagnostic& d : parsed.diagnostics) static_cast<void>(gsd::to_string(d, "fuzz"));
    use(parsed.gsd);
    return 0;
}

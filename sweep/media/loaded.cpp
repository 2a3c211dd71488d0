#include "sweep/files/beside_program.hpp"
#include "sweep/files/system_error.hpp"
#include "sweep/media/entries.hpp"

#include <grainsweep_version.hpp>

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace grainsweep {
namespace media {
namespace {

/// Lets figures use the fonts of an archive of the program. Its configuration includes the system's.
void offer_own_fonts() {
    constexpr int keep = 0;
    std::error_code none;
    const auto own = files::beside_program("fonts/fonts.conf");
    if (std::filesystem::exists(own, none)) ::setenv("FONTCONFIG_FILE", own.c_str(), keep);
}

/// Loads the module; the linker wrote the folders to search into the program (RUNPATH, relative to the program). It is
/// never unloaded, because objects of its classes may live until the end of the process.
const Entries& load() {
    offer_own_fonts();
    constexpr const char* file = "grainsweep_media.so";
    void* const module = ::dlopen(file, RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr)
        throw SystemError(
            fmt::format("figures, workbooks and the live page need {}, which belongs beside the program or "
                        "into ../lib/grainsweep: {}",
                        file, ::dlerror()));
    const auto* const found = static_cast<const Entries*>(::dlsym(module, "grainsweep_media"));
    if (found == nullptr || found->build != std::string_view(GRAINSWEEP_VERSION " " GRAINSWEEP_COMMIT))
        throw SystemError(fmt::format("{} belongs to another version of the program: {}", file,
                                      found == nullptr ? "unknown" : found->build));
    return *found;
}

const Entries& loaded() {
    static const Entries& entries = load();
    return entries;
}

}  // namespace
}  // namespace media

std::string plot::drawn(const Figure& figure, double width_mm, FileType type) {
    return media::loaded().drawn(figure, width_mm, type);
}

std::unique_ptr<report::SheetFile> report::new_sheet_file() {
    return media::loaded().new_sheet_file();
}

std::unique_ptr<live::HttpServer> live::open_http_server(std::uint16_t port, Respond respond) {
    return media::loaded().open_http_server(port, std::move(respond));
}

}  // namespace grainsweep

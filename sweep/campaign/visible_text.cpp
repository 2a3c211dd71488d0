#include "sweep/campaign/visible_text.hpp"

#include <fmt/format.h>

#include <cstddef>

namespace grainsweep::campaign {

std::string visible(std::string_view text) {
    std::string shown;
    shown.reserve(text.size());
    for (std::size_t k = 0; k < text.size(); ++k) {
        const auto c = static_cast<unsigned char>(text[k]);
        const auto next = k + 1 < text.size() ? static_cast<unsigned char>(text[k + 1]) : 0U;
        if ((c < 0x20U && c != '\n' && c != '\t') || c == 0x7FU) {
            shown += fmt::format("\\x{:02x}", c);
        } else if (c == 0xC2U && next >= 0x80U && next < 0xA0U) {  // U+0080 to U+009F in UTF-8
            shown += fmt::format("\\x{:02x}", next);
            ++k;
        } else {
            shown += text[k];
        }
    }
    return shown;
}

}  // namespace grainsweep::campaign

// Reads a film as its format is described (sweep/report/film_codec.hpp, film.hpp), independently of the player.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::tests {

/// Throws std::out_of_range where the bytes end too early.
[[nodiscard]] std::vector<std::uint16_t> unpack_film_column(std::string_view bytes, std::size_t frames,
                                                            std::size_t items);

struct ReadFilm {
    nlohmann::json header;
    std::string blocks;

    /// place: [offset, length] of the header; the block must be used up.
    [[nodiscard]] std::vector<std::uint16_t> column(const nlohmann::json& place, std::size_t frames,
                                                    std::size_t items) const;
};
[[nodiscard]] ReadFilm read_film(const std::string& bytes);

}  // namespace grainsweep::tests

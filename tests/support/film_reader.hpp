// Reads a film as its format is described (sweep/report/packed_column.hpp, film.hpp), independently of the player.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::tests {

/// Throws std::runtime_error for bytes that do not hold so many numbers.
[[nodiscard]] std::vector<std::uint16_t> unpack_film_column(std::string_view packed, std::size_t frames,
                                                            std::size_t items);

struct ReadFilm {
    nlohmann::json header;
    std::string blocks;

    /// number: of the block, as in the header.
    [[nodiscard]] std::vector<std::uint16_t> column(const nlohmann::json& number, std::size_t frames,
                                                    std::size_t items) const;
};
[[nodiscard]] ReadFilm read_film(const std::string& bytes);

}  // namespace grainsweep::tests

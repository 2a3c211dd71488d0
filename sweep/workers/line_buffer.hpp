// Buffer that assembles lines from the pieces of a pipe. It never stores more than one line.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace grainsweep::workers {

class LineBuffer {
public:
    /// `longest`: largest number of bytes of a line without its line end.
    explicit LineBuffer(std::size_t longest) : longest_(longest) {}

    /// Calls `take(line)` for every line that `piece` completes, without its line end, until `take` returns false.
    /// Returns false if a line is too long; the buffer must not be used any more.
    template <class Take>
    [[nodiscard]] bool feed(std::string_view piece, Take&& take) {
        while (!piece.empty()) {
            const std::size_t end = piece.find('\n');
            if (begun_.size() + (end == std::string_view::npos ? piece.size() : end) > longest_) return false;
            if (end == std::string_view::npos) {
                begun_.append(piece);
                return true;
            }
            bool more = false;
            if (begun_.empty()) {
                more = take(piece.substr(0, end));
            } else {
                begun_.append(piece.substr(0, end));
                more = take(std::string_view(begun_));
                begun_.clear();
                if (begun_.capacity() > kept_capacity) begun_.shrink_to_fit();
            }
            if (!more) return true;
            piece.remove_prefix(end + 1);
        }
        return true;
    }

    /// Returns the incomplete last line.
    [[nodiscard]] std::string_view begun() const { return begun_; }

private:
    static constexpr std::size_t kept_capacity = std::size_t{1} << 16U;
    std::size_t longest_;
    std::string begun_;
};

}  // namespace grainsweep::workers

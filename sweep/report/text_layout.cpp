#include "sweep/report/text_layout.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <ostream>
#include <streambuf>
#include <utility>

namespace grainsweep::report {

namespace {

constexpr std::size_t narrowest = 20;
constexpr std::size_t where_nothing_says = 100;
constexpr std::size_t widest_label = 24;  // a longer beginning of a line is text, not its label

std::size_t chosen_width = 0;

bool continues(char c) {  // a character of UTF-8
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

/// Returns the number of bytes at the beginning of the word that fit into the width, cut after a sign if there is one.
std::size_t fitting(std::string_view word, std::size_t width) {
    constexpr std::string_view signs = "_/,-.:|";
    std::size_t end = 0, behind_sign = 0;
    for (std::size_t used = 0; end < word.size(); ++end) {
        if (!continues(word[end]) && used++ == width) break;
        if (signs.find(word[end]) != std::string_view::npos) behind_sign = end + 1;
    }
    return end < word.size() && behind_sign > 0 ? behind_sign : end;
}

/// Returns the words between spaces; "±" and the next word are one.
std::vector<std::string> unbroken(std::string_view text) {
    std::vector<std::string> words;
    bool joined = false;
    for (std::size_t at = 0; (at = text.find_first_not_of(' ', at)) != std::string_view::npos;) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const auto word = text.substr(at, end - at);
        if (joined) {
            words.back().append(" ").append(word);
        } else {
            words.emplace_back(word);
        }
        joined = word == "±";
        at = end;
    }
    return words;
}

std::size_t terminal_width() {
    winsize size{};
    return ::isatty(STDOUT_FILENO) == 1 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

std::size_t environment_width() {
    const char* columns = std::getenv("COLUMNS");
    if (columns == nullptr) return 0;
    const std::string_view word = columns;
    std::size_t width = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), width);
    return error == std::errc() && end == word.data() + word.size() ? width : 0;
}

}  // namespace

std::size_t text_width() {
    std::size_t width = chosen_width;
    if (width == 0) width = terminal_width();
    if (width == 0) width = environment_width();
    if (width == 0) width = where_nothing_says;
    return std::max(width, narrowest);
}

void set_text_width(std::size_t columns) {
    chosen_width = columns;
}

std::size_t columns_of(std::string_view text) {
    return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return !continues(c); }));
}

std::size_t longest_word(std::string_view text) {
    std::size_t longest = 0;
    for (const auto& word : unbroken(text)) longest = std::max(longest, columns_of(word));
    return longest;
}

std::vector<std::string> wrapped(std::string_view text, std::size_t width, bool cut) {
    if (columns_of(text) <= width) return {std::string(text)};
    std::vector<std::string> lines(1);
    for (std::string word : unbroken(text)) {
        if (!lines.back().empty() && columns_of(lines.back()) + 1 + columns_of(word) > width) lines.emplace_back();
        while (cut && columns_of(word) > width) {
            const std::size_t bytes = fitting(word, width);
            lines.back() = word.substr(0, bytes);
            lines.emplace_back();
            word.erase(0, bytes);
        }
        if (!lines.back().empty()) lines.back() += ' ';
        lines.back() += word;
    }
    return lines;
}

/// Collects a line, breaks it and passes it on. A failure of the stream behind is a failure of this one.
class WrappedOutput::Buffer : public std::streambuf {
public:
    Buffer(std::streambuf& behind, std::size_t width) : behind_(&behind), width_(width) {}
    [[nodiscard]] std::streambuf* behind() const { return behind_; }
    bool finish() { return write(std::exchange(line_, {})); }

protected:
    int_type overflow(int_type c) override {
        if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
        const char byte = traits_type::to_char_type(c);
        if (byte != '\n') {
            line_ += byte;
            return c;
        }
        return write(broken(std::exchange(line_, {})) + '\n') ? c : traits_type::eof();
    }
    int sync() override { return behind_->pubsync(); }

private:
    bool write(const std::string& text) {
        const auto size = static_cast<std::streamsize>(text.size());
        return behind_->sputn(text.data(), size) == size;
    }
    [[nodiscard]] static std::size_t indentation_of(std::string_view line) {
        const std::size_t start = std::min(line.find_first_not_of(' '), line.size());
        const std::size_t label_end = line.find("  ", start);
        if (label_end > widest_label) return start;
        const std::size_t behind = line.find_first_not_of(' ', label_end);
        return behind == std::string_view::npos || behind > widest_label ? start : behind;
    }
    [[nodiscard]] std::string broken(std::string line) const {
        if (columns_of(line) <= width_) return line;
        const std::size_t indentation = indentation_of(line);
        const auto lines =
            wrapped(std::string_view(line).substr(indentation), width_ - std::min(width_, indentation), false);
        line.resize(indentation);
        return line + fmt::format("{}", fmt::join(lines, '\n' + std::string(indentation, ' ')));
    }

    std::streambuf* behind_;
    std::size_t width_;
    std::string line_;
};

WrappedOutput::WrappedOutput(std::ostream& out, std::size_t width)
    : out_(&out), buffer_(std::make_unique<Buffer>(*out.rdbuf(), width)) {
    out.rdbuf(buffer_.get());
}

WrappedOutput::~WrappedOutput() {
    auto state = out_->rdstate();  // setting a buffer forgets it
    if (!buffer_->finish()) state |= std::ios::badbit;
    out_->rdbuf(buffer_->behind());
    out_->clear(state);
}

}  // namespace grainsweep::report

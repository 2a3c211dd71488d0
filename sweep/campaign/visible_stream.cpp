#include "sweep/campaign/visible_stream.hpp"

#include "sweep/campaign/visible_text.hpp"

#include <string>

namespace grainsweep::campaign {
namespace {

constexpr char first_of_c1 = '\xC2';

}  // namespace

VisibleStream::VisibleStream(std::ostream& stream) : stream_(stream), behind_(stream.rdbuf(this)) {}

VisibleStream::~VisibleStream() {
    VisibleStream::sync();
    stream_.rdbuf(behind_);
}

VisibleStream::int_type VisibleStream::overflow(int_type c) {
    if (traits_type::eq_int_type(c, traits_type::eof())) return sync() == 0 ? traits_type::not_eof(c) : c;
    const char one = traits_type::to_char_type(c);
    return xsputn(&one, 1) == 1 ? c : traits_type::eof();
}

std::streamsize VisibleStream::xsputn(const char* text, std::streamsize count) {
    std::string whole = half_ ? std::string(1, first_of_c1) : std::string();
    whole.append(text, static_cast<std::size_t>(count));
    half_ = whole.ends_with(first_of_c1);
    if (half_) whole.pop_back();
    const auto shown = visible(whole);
    const auto size = static_cast<std::streamsize>(shown.size());
    return behind_->sputn(shown.data(), size) == size ? count : 0;
}

int VisibleStream::sync() {
    if (half_) behind_->sputc(first_of_c1);
    half_ = false;
    return behind_->pubsync();
}

}  // namespace grainsweep::campaign

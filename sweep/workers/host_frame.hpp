// The protocol of main program and host (host.hpp), on one page. A frame is a line of words. The bytes and a newline
// follow a frame with a length. SUM, the last field, is the CRC of cksum(1) over the line without SUM, a newline, and
// the bytes. The host refuses a frame with another CRC. The main program numbers workers and never reuses a number.
// Messages of workers (message.hpp) travel in the pieces that a pipe delivers: the host does not read them.
//
//   main program                     host
//          start 7 SUM                      grainsweep host 2    first; the number of this protocol
//          7 120 SUM <bytes>                7 80 SUM <bytes>     standard input and output of worker 7
//          signal 7 15 SUM                  alive                every second
//          close 7 SUM                      ended 7 9 33 SUM <log>   its status as of waitpid(2), the last it wrote
//          lease                                                     to standard error
//
// `close`: the worker's pipes are closed; its end is still told. End of file in either direction means that the other
// side is gone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

namespace grainsweep::workers::frames {

inline constexpr std::int64_t host_protocol = 2;
/// Bytes that one frame carries.
inline constexpr std::size_t longest_piece = std::size_t{64} << 10U;

using WorkerNumber = std::uint64_t;

struct Hello {
    std::int64_t protocol = host_protocol;
};
struct Start {
    WorkerNumber worker = 0;
};
struct Piece {
    WorkerNumber worker = 0;
    std::string_view bytes;  ///< good during the call
};
struct Signal {
    WorkerNumber worker = 0;
    int number = 0;
};
struct Close {
    WorkerNumber worker = 0;
};
struct Ended {
    WorkerNumber worker = 0;
    int status = 0;
    std::string_view log;  ///< good during the call
};
/// Of the main program `lease`, of a host `alive`: it lives.
struct Beat {};
/// A line before a host's first frame: its launcher's, which may greet.
struct Greeting {
    std::string_view line;
};
using Frame = std::variant<Hello, Start, Piece, Signal, Close, Ended, Beat, Greeting>;

void add_hello(std::string& to);
void add_start(std::string& to, WorkerNumber worker);
/// Longer ones in several frames.
void add_piece(std::string& to, WorkerNumber worker, std::string_view bytes);
void add_signal(std::string& to, WorkerNumber worker, int number);
void add_close(std::string& to, WorkerNumber worker);
void add_ended(std::string& to, WorkerNumber worker, int status, std::string_view log);
inline constexpr std::string_view lease_frame = "lease\n";
inline constexpr std::string_view alive_frame = "alive\n";

/// Puts frames together from what a pipe brings, and never keeps more than one.
class Reader {
public:
    enum class Side {
        main_program,  ///< reads what a host wrote: greetings until it says what it is
        host,          ///< reads what the main program wrote
    };
    explicit Reader(Side side) : greeted_(side == Side::host) {}

    /// Calls `take(frame)` for every frame that is complete. Returns false at what is no frame: what follows has no
    /// meaning.
    template <class Take>
    [[nodiscard]] bool feed(std::string_view piece, Take&& take) {
        std::string joined;
        if (!begun_.empty()) {
            joined = std::move(begun_);
            joined.append(piece);
            piece = joined;
        }
        while (!piece.empty()) {
            Frame frame;
            const std::size_t length = parse(piece, frame);
            if (length == nonsense) return false;
            if (length == 0) break;
            take(frame);
            piece.remove_prefix(length);
        }
        begun_ = piece;
        return true;
    }

private:
    static constexpr std::size_t nonsense = static_cast<std::size_t>(-1);
    /// Bytes of the frame that begins here; 0: not complete yet.
    std::size_t parse(std::string_view text, Frame& frame);

    bool greeted_;
    std::size_t greeting_bytes_ = 0;
    std::string begun_;
};

}  // namespace grainsweep::workers::frames

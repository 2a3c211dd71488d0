// The protocol of main program and host (host.hpp), on one page. A frame is a line of words. The bytes and a newline
// follow a frame with a length. SUM, the last field, is the CRC of cksum(1) over the line without SUM, a newline, and
// the bytes. The host refuses a frame with another CRC. The main program numbers workers and never reuses a number.
// Messages of workers (message.hpp) travel in the pieces that a pipe delivers: the host does not read them.
//
//   main program                     host
//          start 7 SUM                      grainsweep host 2    first; the number of this protocol
//          7 120 SUM <bytes>                7 80 SUM <bytes>     standard input and output of worker 7
//          signal 7 15 SUM                  alive                every second
//          close 7 SUM                      ended 7 9 33 SUM <log>   its status as of waitpid(2), the end of
//          lease                                                     its standard error
//
// `close`: the worker's pipes are closed; `ended` still follows. End of file in either direction means that the other
// side is gone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

namespace grainsweep::workers::frames {

inline constexpr std::int64_t host_protocol = 2;
/// Largest number of bytes in one frame.
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
    std::string_view bytes;  ///< valid during the call
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
    std::string_view log;  ///< valid during the call
};
/// Heartbeat: `lease` of the main program, `alive` of a host.
struct Beat {};
/// Line before a host's first frame, written by its launcher.
struct Greeting {
    std::string_view line;
};
using Frame = std::variant<Hello, Start, Piece, Signal, Close, Ended, Beat, Greeting>;

void add_hello(std::string& to);
void add_start(std::string& to, WorkerNumber worker);
/// Appends the bytes as one frame, or as several if they are longer than longest_piece.
void add_piece(std::string& to, WorkerNumber worker, std::string_view bytes);
void add_signal(std::string& to, WorkerNumber worker, int number);
void add_close(std::string& to, WorkerNumber worker);
void add_ended(std::string& to, WorkerNumber worker, int status, std::string_view log);
inline constexpr std::string_view lease_frame = "lease\n";
inline constexpr std::string_view alive_frame = "alive\n";

/// Reader that assembles frames from the pieces of a pipe. It never stores more than one frame.
class Reader {
public:
    enum class Side {
        main_program,  ///< reads the output of a host: greetings until the host names itself
        host,          ///< reads the output of the main program
    };
    explicit Reader(Side side) : greeted_(side == Side::host) {}

    /// Calls `take(frame)` for every complete frame. Returns false at an invalid frame; the bytes after it are not
    /// read.
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
    /// Returns the bytes of the frame that begins here; 0: it is not complete yet.
    std::size_t parse(std::string_view text, Frame& frame);

    bool greeted_;
    std::size_t greeting_bytes_ = 0;
    std::string begun_;
};

}  // namespace grainsweep::workers::frames

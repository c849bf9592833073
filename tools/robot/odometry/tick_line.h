/* What a board says of its wheels, a line each time:
 *
 *   $TICKS,1042,-17,48120034*9B1C
 *
 * Ticks of the left and the right wheel since the board's start, its microseconds, and CRC-16/CCITT-FALSE in
 * hex of what stands between $ and *. All three count on beyond 32 bits by wrapping. The line ends with
 * carriage return, line feed, or both. */
#ifndef ALE_ROBOT_ODOMETRY_TICK_LINE_H
#define ALE_ROBOT_ODOMETRY_TICK_LINE_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace odometry
{

struct Ticks {
    uint32_t left;
    uint32_t right;
    uint32_t micros;
};

/* A line without its end; nothing when it is not one. */
std::optional<Ticks> ticks_of(const std::string &line);

class TickLines
{
  public:
    /* The next byte of the line: ticks when it was the last one of theirs. Memory is bounded whatever comes.
     */
    std::optional<Ticks> take(char byte);
    uint64_t taken() const
    {
        return taken_;
    }
    /* Lines that were none. */
    uint64_t refused() const
    {
        return refused_;
    }
    /* How the last of these began, as text. */
    const std::string &strange() const
    {
        return strange_;
    }

  private:
    static constexpr size_t longest = 64;
    std::string text_;
    std::string strange_;
    uint64_t taken_ = 0;
    uint64_t refused_ = 0;
};

} // namespace odometry

#endif

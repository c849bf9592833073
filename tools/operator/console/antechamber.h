/* Where connections wait that have not shown the token yet: each for a while only, and not many. Whoever
 * opens connections and says nothing, or a byte a second, loses his own and holds up nobody else.
 *
 * Pure: the server closes what this says. */
#ifndef CONSOLE_ANTECHAMBER_H
#define CONSOLE_ANTECHAMBER_H

#include <chrono>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace console
{

class Antechamber
{
  public:
    using Clock = std::chrono::steady_clock;
    using Id = void *;

    static constexpr size_t most = 64;
    static constexpr std::chrono::seconds patience{15};

    /* Somebody has come. When there are too many: the oldest of the peer that has most of them, who must go.
     */
    std::optional<Id> enter(Id id, const std::string &peer, Clock::time_point now);

    /* He has shown the token, and may wait as long again. */
    void renew(Id id, Clock::time_point now);

    /* He is in, or gone. Unknown ones: nothing. */
    void leave(Id id);

    /* Those whose time is over. */
    std::vector<Id> overdue(Clock::time_point now) const;

  private:
    struct Waiting {
        std::string peer;
        Clock::time_point since;
    };

    std::unordered_map<Id, Waiting> waiting_;
};

} // namespace console

#endif

/* The other ends: who is being greeted, and who has proved who he is. The robot's end has some operators, an
 * operator's end one robot. Pure but for random numbers and the words on stderr.
 *
 * Of a greeting that is not gone through with only some bytes are kept, of at most 16 at a time; who is there
 * already loses nothing by it. */
#ifndef BRIDGE_ENDS_H
#define BRIDGE_ENDS_H

#include <cstdint>
#include <list>
#include <optional>
#include <vector>

#include "operator/bridge/handshake.h"
#include "operator/bridge/session.h"

namespace bridge
{

class Ends
{
  public:
    /* The robot's end: its own key, and whom it lets in. */
    static Ends of_robot(const ale_secret_key_t &own, const ale_keys_t &operators);

    /* An operator's end: his key, the robots that he believes, and where one of them is. */
    static Ends of_operator(const ale_secret_key_t &own, const ale_keys_t &robots, const Address &robot);

    /* The answer to a hello; empty: of nobody who is known, or too many at a time. */
    std::vector<uint8_t> greet(const std::vector<uint8_t> &datagram, const Address &from, int64_t now_us);

    /* The hello to be sent; empty: nobody is looked for. */
    std::vector<uint8_t> hello();
    const Address &wanted() const
    {
        return wanted_;
    }

    /* The answer to it. False: it is none. */
    bool greeted(const std::vector<uint8_t> &datagram, const Address &from, int64_t now_us);

    /* Whose session the datagram says to be of; NULL: nobody's. */
    Session *of(const std::vector<uint8_t> &datagram);

    /* He has shown that he has the keys: from now on he is sent to. */
    void confirm(Session &session);

    void forget_silent(int64_t now_us);

    /* Those who are sent to. */
    std::list<Session> &sessions()
    {
        return sessions_;
    }

    uint64_t lost() const;
    uint64_t late() const;

  private:
    static constexpr size_t most_sessions = 8;
    static constexpr size_t most_greeted = 16;
    static constexpr int most_hellos_a_second = 50; /* each costs a signature */

    struct Greeted {
        PublicHalf ephemeral;
        std::vector<uint8_t> answer;
        std::list<Session> session; /* one */
    };

    bool may_greet(int64_t now_us);
    void end(const Session &session);

    bool robot_ = false;
    ale_secret_key_t own_{};
    ale_keys_t known_{};
    Address wanted_;
    std::optional<Ephemeral> looking_;
    std::list<Greeted> greeted_;
    std::list<Session> sessions_;
    int64_t second_us_ = 0;
    int hellos_ = 0;
    uint64_t lost_ = 0; /* of sessions that are over */
    uint64_t late_ = 0;
};

} // namespace bridge

#endif

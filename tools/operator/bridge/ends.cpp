#include "operator/bridge/ends.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

namespace bridge
{

namespace
{

constexpr int64_t second_us = 1000000;

uint64_t random_number()
{
    uint64_t number = 0;
    randombytes_buf(&number, sizeof number);
    return number;
}

void tell(const Session &session, const char *what)
{
    std::fprintf(stderr, "ale-bridge: %s at %s %s\n", session.name().c_str(),
                 session.address().name().c_str(), what);
}

} // namespace

Ends Ends::of_robot(const ale_secret_key_t &own, const ale_keys_t &operators)
{
    Ends ends;
    ends.robot_ = true;
    ends.own_ = own;
    ends.known_ = operators;
    return ends;
}

Ends Ends::of_operator(const ale_secret_key_t &own, const ale_keys_t &robots, const Address &robot)
{
    Ends ends;
    ends.own_ = own;
    ends.known_ = robots;
    ends.wanted_ = robot;
    return ends;
}

bool Ends::may_greet(int64_t now_us)
{
    if (now_us - second_us_ >= second_us) {
        second_us_ = now_us;
        hellos_ = 0;
    }
    return robot_ && hellos_++ < most_hellos_a_second;
}

std::vector<uint8_t> Ends::greet(const std::vector<uint8_t> &datagram, const Address &from, int64_t now_us)
{
    const auto hello = may_greet(now_us) ? check_hello(datagram, known_) : std::nullopt;
    if (!hello) {
        return {};
    }
    const auto again = std::find_if(greeted_.begin(), greeted_.end(),
                                    [&](const Greeted &one) { return one.ephemeral == hello->ephemeral; });
    if (again != greeted_.end()) {
        return again->answer;
    }
    const Ephemeral mine = Ephemeral::make();
    const auto keys = robot_keys(mine, hello->ephemeral);
    if (!keys || sessions_.size() >= most_sessions) {
        return {};
    }
    if (greeted_.size() >= most_greeted) {
        greeted_.pop_front();
    }
    const uint64_t number = random_number();
    greeted_.push_back({hello->ephemeral, make_answer(own_, *hello, mine.open, number), {}});
    greeted_.back().session.emplace_back(number, hello->name, *keys, from);
    return greeted_.back().answer;
}

std::vector<uint8_t> Ends::hello()
{
    if (robot_ || !sessions_.empty()) {
        return {};
    }
    if (!looking_) {
        looking_ = Ephemeral::make();
    }
    return make_hello(own_, looking_->open);
}

bool Ends::greeted(const std::vector<uint8_t> &datagram, const Address &from, int64_t now_us)
{
    const auto answer = looking_ ? check_answer(datagram, known_, looking_->open) : std::nullopt;
    const auto keys = answer ? operator_keys(*looking_, answer->ephemeral) : std::nullopt;
    if (!keys) {
        return false;
    }
    sessions_.emplace_back(answer->session, answer->name, *keys, from);
    sessions_.back().wait_from(now_us);
    looking_.reset();
    tell(sessions_.back(), "is there");
    return true;
}

Session *Ends::of(const std::vector<uint8_t> &datagram)
{
    const auto number = session_of(datagram);
    const auto is = [&](const Session &session) { return session.number() == *number; };
    if (!number) {
        return nullptr;
    }
    const auto found = std::find_if(sessions_.begin(), sessions_.end(), is);
    if (found != sessions_.end()) {
        return &*found;
    }
    const auto greeted = std::find_if(greeted_.begin(), greeted_.end(),
                                      [&](const Greeted &one) { return is(one.session.front()); });
    return greeted == greeted_.end() ? nullptr : &greeted->session.front();
}

void Ends::confirm(Session &session)
{
    const auto found = std::find_if(greeted_.begin(), greeted_.end(),
                                    [&](const Greeted &one) { return &one.session.front() == &session; });
    if (found != greeted_.end()) {
        sessions_.splice(sessions_.end(), found->session);
        greeted_.erase(found);
        tell(session, "is there");
    }
}

void Ends::end(const Session &session)
{
    lost_ += session.arrivals().lost();
    late_ += session.arrivals().late();
    tell(session, "is silent: waiting until it is there again");
}

void Ends::forget_silent(int64_t now_us)
{
    for (auto one = sessions_.begin(); one != sessions_.end();) {
        if (one->is_silent(now_us)) {
            end(*one);
            one = sessions_.erase(one);
        } else {
            ++one;
        }
    }
}

uint64_t Ends::lost() const
{
    return std::accumulate(sessions_.begin(), sessions_.end(), lost_,
                           [](uint64_t sum, const Session &one) { return sum + one.arrivals().lost(); });
}

uint64_t Ends::late() const
{
    return std::accumulate(sessions_.begin(), sessions_.end(), late_,
                           [](uint64_t sum, const Session &one) { return sum + one.arrivals().late(); });
}

} // namespace bridge

#include "operator/console/recordings/desk.h"

#include <optional>
#include <stdexcept>
#include <utility>

#include "operator/console/recordings/shelf_message.h"

namespace console
{

namespace
{

constexpr unsigned not_there = 404;
constexpr unsigned failed = 500;

/* What came of looking for something to download. */
struct Found {
    std::optional<Content> content;
    std::string trouble;
};

} // namespace

void Desk::open(std::function<void()> wake)
{
    errands_ = std::make_unique<Errands>(wake);
    long_errands_ = std::make_unique<Errands>(std::move(wake));
}

void Desk::close()
{
    archive_.stop_replays();
    long_errands_.reset();
    errands_.reset();
}

std::string Desk::list(const std::string &refusal)
{
    return shelf_message(archive_.recordings(recorder_.state().name), archive_.flights(), archive_.maps(),
                         refusal);
}

std::string Desk::record(bool on)
{
    try {
        on ? recorder_.start() : recorder_.stop();
    } catch (const std::runtime_error &error) {
        return error.what();
    }
    return "";
}

bool Desk::ask(const PageMessage &message, Tell tell)
{
    if (message.kind == PageMessage::Kind::open) {
        return open_recording(message.name, std::move(tell));
    }
    const bool records = message.kind == PageMessage::Kind::record;
    return errands_ && errands_->run([this, records, on = message.on, tell = std::move(tell)] {
        std::string text = list(records ? record(on) : "");
        return [tell, text = std::move(text)] { tell.text(text); };
    });
}

bool Desk::open_recording(const std::string &name, Tell tell)
{
    const auto &errands = Archive::is_flight(name) ? long_errands_ : errands_;
    return errands && errands->run([this, name, tell = std::move(tell)]() -> Errands::Done {
        try {
            auto recording = archive_.open(name);
            return [tell, recording = std::move(recording), name] { tell.recording(recording, name); };
        } catch (const std::runtime_error &error) {
            return [tell, text = list(error.what())] { tell.text(text); };
        }
    });
}

bool Desk::fetch(lws *connection, const Wanted &wanted)
{
    if (!errands_ || !downloads_.has_room()) {
        return false;
    }
    const uint64_t ticket = downloads_.expect(connection);
    const auto &errands = wanted.takes_long() ? long_errands_ : errands_;
    return errands->run([this, ticket, wanted] {
        const auto found = std::make_shared<Found>();
        try {
            found->content = archive_.fetch(wanted);
        } catch (const std::runtime_error &error) {
            found->trouble = error.what();
        }
        return [this, ticket, wanted, found] {
            if (found->content) {
                downloads_.found(ticket, wanted, std::move(*found->content));
            } else {
                downloads_.missing(ticket, found->trouble.empty() ? not_there : failed,
                                   found->trouble.empty() ? "there is no such file here" : found->trouble);
            }
        };
    });
}

void Desk::hand_out()
{
    for (const auto *errands : {&long_errands_, &errands_}) {
        if (*errands) {
            for (const auto &done : (*errands)->done()) {
                done();
            }
        }
    }
}

} // namespace console

/* Faults on the line and in the device, each at its time.
 *
 *   SPEC   = FAULT [ "," FAULT ]...
 *   FAULT  = NAME [ ":" ARGUMENT ] "@" WHEN
 *   WHEN   = seconds of play, or "#" and the number of a scan (from 0)
 *
 *   flip           one bit of one byte of the next frame is turned over
 *   cut            the next frame ends in its middle
 *   garbage:N      N bytes of anything before the next frame (300)
 *   repeat         the next frame is sent twice
 *   silence:S      for S seconds the device hears nothing and says nothing (2)
 *   unplug:S       the device is gone for S seconds and comes back as after power-up (2)
 *   reset11        the device starts anew, in SCIP 1.1
 *   stall:S        the motor of a rotary scanner stands still for S seconds (2)
 *   hardware:NN    the stream ends with the status NN instead of ranges (50)
 *   wrap           the device's clock passes 2^24 ms; here WHEN counts from the program's start
 */
#ifndef ALE_LAB_SIM_FAULTS_H
#define ALE_LAB_SIM_FAULTS_H

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lab/bench/random.hpp"

namespace sim
{

enum class FaultKind { flip, cut, garbage, repeat, silence, unplug, reset11, hardware, wrap, stall };

struct Fault {
    FaultKind kind;
    double argument; /* bytes, seconds or a status; see above */
    int64_t at_us;   /* of play; -1: at a scan */
    int64_t at_scan; /* -1: at a time */
};

/* Throws cli::WrongUse that names the fault and what is wrong with it. */
std::vector<Fault> parse_faults(const std::string &spec);

class Faults
{
  public:
    Faults(const std::string &spec, uint64_t seed);

    /* When the counter is to wrap, in microseconds after the program's start. */
    std::optional<int64_t> wrap_us() const;

    /* Faults of link and device whose time has come; each is handed out once. scan: the next to come. */
    std::vector<Fault> due(int64_t play_us, int64_t scan);
    /* When the next fault that waits for a time is due; INT64_MAX: none. */
    int64_t next_due_us() const;

    /* The frame as it leaves the line at that time. */
    std::string damage(const std::string &frame, int64_t play_us, int64_t scan);

  private:
    std::string damage_by(const Fault &fault, const std::string &frame);

    std::vector<Fault> pending_;
    bench::Random random_;
};

} // namespace sim

#endif

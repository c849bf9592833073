#include "operator/ros2/dds.h"

#include <memory>
#include <stdexcept>
#include <utility>

namespace ros2
{

namespace
{

constexpr dds_duration_t longest_wait = DDS_MSECS(20);

/* Participants find each other by unicast over the loopback, which has no multicast on most machines. */
constexpr char this_machine[] =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface address=\"127.0.0.1\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
    "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><Peers><Peer address=\"127.0.0.1\"/></Peers>"
    "</Discovery></Domain></CycloneDDS>";

dds_entity_t made(dds_entity_t entity, const std::string &what)
{
    if (entity < 0) {
        throw std::runtime_error("DDS: " + what + ": " + dds_strretcode(entity));
    }
    return entity;
}

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

Qos writer_qos(Quality quality, int32_t depth)
{
    Qos qos(dds_create_qos(), dds_delete_qos);
    const bool latched = quality == Quality::latched;
    dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, longest_wait);
    dds_qset_durability(qos.get(), latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
    dds_qset_writer_data_lifecycle(qos.get(), false);
    return qos;
}

Qos reader_qos(bool reliable)
{
    Qos qos(dds_create_qos(), dds_delete_qos);
    dds_qset_reliability(qos.get(), reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
    return qos;
}

dds_entity_t make_topic(const Participant &participant, const std::string &name,
                        const dds_topic_descriptor_t &type)
{
    const std::string full = participant.topic(name);
    return made(dds_create_topic(participant.handle(), &type, full.c_str(), nullptr, nullptr), full);
}

dds_entity_t make_domain(uint32_t domain, bool only_here)
{
    return only_here ? made(dds_create_domain(domain, this_machine), "this machine's own domain") : 0;
}

} // namespace

Participant::Participant(uint32_t domain, bool only_here, std::string space)
    : space_(std::move(space)), domain_(make_domain(domain, only_here)),
      participant_(made(dds_create_participant(domain, nullptr, nullptr), "domain " + std::to_string(domain)))
{
}

std::string Participant::topic(const std::string &name) const
{
    return "rt/" + (space_.empty() ? "" : space_ + "/") + name;
}

dds_entity_t make_writer(const Participant &participant, const std::string &name,
                         const dds_topic_descriptor_t &type, Quality quality, int32_t depth)
{
    const dds_entity_t topic = make_topic(participant, name, type);
    const Qos qos = writer_qos(quality, depth);
    return made(dds_create_writer(participant.handle(), topic, qos.get(), nullptr), "/" + name);
}

dds_entity_t make_reader(const Participant &participant, const std::string &name,
                         const dds_topic_descriptor_t &type, bool reliable)
{
    const dds_entity_t topic = make_topic(participant, name, type);
    const Qos qos = reader_qos(reliable);
    return made(dds_create_reader(participant.handle(), topic, qos.get(), nullptr), "/" + name);
}

} // namespace ros2

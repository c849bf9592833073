/* Topics of ROS 2 on DDS: a participant, and typed writers and readers with the quality of service that nav2
 * and RViz2 ask for.
 *
 *   Participant participant(domain, only_here);
 *   Writer<sensor_msgs_msg_dds__LaserScan_> scans(participant, "scan", sensor_msgs_msg_dds__LaserScan__desc,
 *                                                 Quality::stream);
 *   scans.write(message);                        never waits longer than 20 ms
 *   Reader<geometry_msgs_msg_dds__Twist_> twists(participant, "cmd_vel", ..., false);
 *   twists.newest([](const auto &message) { ... });
 *
 * All throw std::runtime_error in one line when DDS refuses. One thread. */
#ifndef ROS2_DDS_H
#define ROS2_DDS_H

#include <cstdint>
#include <string>

#include <dds/dds.h>

namespace ros2
{

enum class Quality {
    stream, /* reliable, volatile: what comes again */
    latched /* reliable, the newest is kept for who comes later (transient local) */
};

/* Ends what DDS has made. */
class Entity
{
  public:
    explicit Entity(dds_entity_t handle) : handle_(handle)
    {
    }
    ~Entity()
    {
        dds_delete(handle_);
    }
    Entity(const Entity &) = delete;
    Entity &operator=(const Entity &) = delete;

    dds_entity_t handle() const
    {
        return handle_;
    }

  private:
    dds_entity_t handle_;
};

class Participant
{
  public:
    /* only_here: neither heard nor seen by other machines; who is to hear it on this one must be told so, too
     * (ROS_LOCALHOST_ONLY=1). space: empty, or what stands before the names of all topics. */
    Participant(uint32_t domain, bool only_here, std::string space);

    dds_entity_t handle() const
    {
        return participant_.handle();
    }
    /* "rt/scan", "rt/rover1/scan" */
    std::string topic(const std::string &name) const;

  private:
    std::string space_;
    Entity domain_;
    Entity participant_;
};

dds_entity_t make_writer(const Participant &participant, const std::string &name,
                         const dds_topic_descriptor_t &type, Quality quality, int32_t depth);
dds_entity_t make_reader(const Participant &participant, const std::string &name,
                         const dds_topic_descriptor_t &type, bool reliable);

template <class Message> class Writer
{
  public:
    Writer(const Participant &participant, const std::string &name, const dds_topic_descriptor_t &type,
           Quality quality, int32_t depth)
        : entity_(make_writer(participant, name, type, quality, depth))
    {
    }

    /* False: who listens reliably could not keep up, and the message is lost to him. */
    bool write(const Message &message)
    {
        return dds_write(entity_.handle(), &message) == DDS_RETCODE_OK;
    }

  private:
    Entity entity_;
};

/* Volatile; only the newest message is kept. Not reliable: matches whatever publisher there is. */
template <class Message> class Reader
{
  public:
    Reader(const Participant &participant, const std::string &name, const dds_topic_descriptor_t &type,
           bool reliable)
        : entity_(make_reader(participant, name, type, reliable))
    {
    }

    /* Hands over what has come since the last call, if anything has. */
    template <class Take> void newest(Take take)
    {
        void *sample[1] = {nullptr};
        dds_sample_info_t info;
        const dds_return_t count = dds_take(entity_.handle(), sample, &info, 1, 1);
        if (count > 0) {
            if (info.valid_data) {
                take(*static_cast<const Message *>(sample[0]));
            }
            dds_return_loan(entity_.handle(), sample, count);
        }
    }

  private:
    Entity entity_;
};

} // namespace ros2

#endif

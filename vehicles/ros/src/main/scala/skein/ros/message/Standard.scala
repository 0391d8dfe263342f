package skein.ros.message

import skein.units.Instant

/** `builtin_interfaces/Time`.
  *
  * @param nanosec 0 to 999,999,999
  */
final case class Time(sec: Int, nanosec: Int) derives Cdr:
  def instant: Instant = Instant.ofNanos(sec * 1_000_000_000L + (nanosec & 0xffffffffL))

object Time:
  def of(at: Instant): Time =
    Time(
      Math.floorDiv(at.toNanos, 1_000_000_000L).toInt,
      Math.floorMod(at.toNanos, 1_000_000_000L).toInt
    )

/** `std_msgs/Header`: when its message was valid, and in which frame. */
final case class Header(stamp: Time, frameId: String) derives Cdr

/** `rosgraph_msgs/Clock`: the time of a simulation, for nodes with `use_sim_time`. */
final case class Clock(clock: Time) derives Cdr

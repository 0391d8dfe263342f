package skein.simulator

import skein.link.Address

/** The ports on which the vehicles speak MAVLink.
  *
  * @param listen address for all vehicles, by the simulator's own transport, which is TCP outside tests
  * @param udp ports for datagrams, whatever the transport
  * @param firstSystem the first vehicle's system number
  */
final case class MavlinkSettings(
    listen: Option[Address] = None,
    udp: Vector[MavlinkPort] = Vector.empty,
    firstSystem: Int = 1
)

/** A UDP port of some vehicles. It answers every peer that sends to it.
  *
  * @param tells a peer that receives messages without having sent one
  * @param systems system numbers of the vehicles; empty: all
  */
final case class MavlinkPort(at: Address, tells: Option[Address] = None, systems: Vector[Int] = Vector.empty)

object MavlinkSettings:
  /** The ports of PX4's simulation (`px4-rc.mavlink`). On this machine, a ground station that listens at
    * 14550 is connected to all vehicles, and a program that listens at 14540 + i to vehicle `i`. Any peer
    * reaches all vehicles by sending to 18570.
    *
    * @param instance PX4 instance of the first vehicle; it is added to `i`, to 18570 and to the system IDs
    */
  def asPx4(vehicles: Int, host: String = "127.0.0.1", instance: Int = 0): MavlinkSettings = MavlinkSettings(
    udp =
      MavlinkPort(Address(host, GroundStation + instance), Some(Address("127.0.0.1", 14550))) +:
        Vector.tabulate(vehicles)(_ + instance).map(i =>
          MavlinkPort(Address(host, 14580 + i), Some(Address("127.0.0.1", 14540 + i)), Vector(i + 1))
        ),
    firstSystem = instance + 1
  )

  /** The maximum system number of a vehicle; the least is 1. */
  val MostSystems = 250

  val GroundStation = 18570

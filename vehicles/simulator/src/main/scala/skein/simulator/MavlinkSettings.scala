package skein.simulator

import skein.link.Address

/** Where the vehicles are reached by MAVLink.
  *
  * @param listen all vehicles, for who connects there by the simulator's own transport, which is TCP where
  *   that is real
  * @param udp by datagrams, whatever the transport
  * @param firstSystem the first vehicle's system number
  */
final case class MavlinkSettings(
    listen: Option[Address] = None,
    udp: Vector[MavlinkPort] = Vector.empty,
    firstSystem: Int = 1
)

/** A UDP port of some vehicles. It answers everybody who speaks to it.
  *
  * @param tells who is told without having asked
  * @param systems none is all
  */
final case class MavlinkPort(at: Address, tells: Option[Address] = None, systems: Vector[Int] = Vector.empty)

object MavlinkSettings:
  /** As PX4's simulation has them (`px4-rc.mavlink`): a ground station finds all vehicles at its port 14550,
    * a program vehicle `i` at 14540 + i, both on this machine; and whoever speaks to 18570 has all, too.
    *
    * @param instance the first vehicle's, as PX4 counts: `i` begins with it, and 18570 and the system numbers
    *   are higher by it
    */
  def asPx4(vehicles: Int, host: String = "127.0.0.1", instance: Int = 0): MavlinkSettings = MavlinkSettings(
    udp =
      MavlinkPort(Address(host, GroundStation + instance), Some(Address("127.0.0.1", 14550))) +:
        Vector.tabulate(vehicles)(_ + instance).map(i =>
          MavlinkPort(Address(host, 14580 + i), Some(Address("127.0.0.1", 14540 + i)), Vector(i + 1))
        ),
    firstSystem = instance + 1
  )

  /** Numbers that vehicles may have: 1 to this. */
  val MostSystems = 250

  /** Of all vehicles. */
  val GroundStation = 18570

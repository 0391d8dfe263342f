package skein.scenario

import skein.policy.*
import skein.units.*
import skein.units.Decimals.significant

/** Vehicles side by side cross a forest, each along a lane of its own, and detect trees and one another only
  * with lidar.
  *
  * @param vehicles number of vehicles
  * @param apartM distance between neighbouring lanes
  * @param cruiseMps speed along the lane
  * @param lengthM length of the lanes, which end beyond the last tree
  * @param altitudeM altitude of all vehicles
  * @param keepM distance to keep from trees and vehicles, if there is room
  */
final case class Forest(
    vehicles: Int = 5,
    apartM: Double = 9,
    cruiseMps: Double = 5,
    lengthM: Double = 112,
    altitudeM: Double = 4,
    keepM: Double = 1.2
) extends Scenario:

  override def mistakes: Seq[String] =
    Scenario.outside("vehicles", vehicles, 1, 7).toSeq ++ Scenario.notPositive(this)

  def agents: Vector[Agent] = Vector.tabulate(vehicles): vehicle =>
    val eastM = (vehicle - (vehicles - 1) / 2.0) * apartM
    Agent(
      s"Scout${vehicle + 1}",
      Role("Scout"),
      MetresPerSecond(cruiseMps),
      Vector3(0, eastM, -altitudeM),
      Radians(0),
      DynamicWindow(Forest.Lidar, 0, eastM, Radians(0), cruiseMps, keepM)
    )

  override def scene: String = "forest"

  override def equipment: Vector[Equipment] =
    agents.map(agent => Equipment.Lidar(agent.name, Forest.Lidar))

  override def isOver(known: Known): Boolean =
    known.vehicles.forall(_.kinematics.positionNed.x > lengthM)

  override def limits: Vector[Limit] = Vector(Limit.separation(Metres(1)))

  override def measures: Vector[Measure] = Vector(
    Measure("to cross", "s"): tracks =>
      val times = crossedS(tracks)
      Option.when(times.nonEmpty)(times.sum / times.size)
    ,
    Measure.count("crossed")(crossedS(_).size)
  )

  override def note: String =
    s"To cross: mean time to ${lengthM.significant(3)} m to the north, of the " +
      "vehicles that came there. Trees are known by lidar alone."

  private def crossedS(tracks: Tracks): Vector[Double] =
    for
      vehicle <- tracks.vehicles.toVector
      instant <- tracks.instants.find(tracks.northM(vehicle)(_) >= lengthM)
    yield tracks.timeS(instant)

object Forest:
  private val Lidar = "lidar"

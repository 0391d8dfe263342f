package skein.policy

import skein.signal.Kinematics
import skein.units.*

/** Simulates a team by its policies without delays. Each velocity follows its command with a first-order lag.
  *
  * @param lagS time constant, s; with 0, velocities equal their commands immediately
  */
final class TeamFlight(scenario: Fleet, lagS: Double, stepS: Double = 0.05):
  private val agents  = scenario.agents
  val northM          = agents.map(_.startPositionNed.x).toArray
  val eastM           = agents.map(_.startPositionNed.y).toArray
  val northMps        = Array.fill(agents.size)(0.0)
  val eastMps         = Array.fill(agents.size)(0.0)
  private val heading = agents.map(_.startHeading.value).toArray

  /** The smallest distance between any two vehicles so far, m. */
  var leastM: Double = Double.PositiveInfinity

  def seenBy(vehicle: Int): Observation =
    TeamFlight.seen(
      vehicle,
      northM.toSeq,
      eastM.toSeq,
      northMps.toSeq,
      eastMps.toSeq,
      heading(vehicle),
      stepS
    )

  def fly(seconds: Double)(after: => Unit = ()): Unit =
    for _ <- 1 to math.round(seconds / stepS).toInt do
      val actions = agents.indices.map: vehicle =>
        val policy = agents(vehicle).policy
        policy.choose(seenBy(vehicle), policy.start)._1
      val share = if lagS == 0 then 1.0 else 1 - math.exp(-stepS / lagS)
      for (action, vehicle) <- actions.zipWithIndex do
        heading(vehicle) = action.headingRad(heading(vehicle))
        val speed = action.speed.value
        northMps(vehicle) += share * (speed * math.cos(heading(vehicle)) - northMps(vehicle))
        eastMps(vehicle) += share * (speed * math.sin(heading(vehicle)) - eastMps(vehicle))
        northM(vehicle) += northMps(vehicle) * stepS
        eastM(vehicle) += eastMps(vehicle) * stepS
      for one <- agents.indices; other <- 0 until one do leastM = leastM.min(distanceM(one, other))
      after

  def distanceM(one: Int, other: Int): Double =
    math.hypot(northM(one) - northM(other), eastM(one) - eastM(other))

object TeamFlight:
  /** One vehicle's observation of a team that flies at one altitude, without an opponent. */
  def seen(
      self: Int,
      northM: Seq[Double],
      eastM: Seq[Double],
      northMps: Seq[Double],
      eastMps: Seq[Double],
      headingRad: Double,
      elapsedS: Double
  ): Observation = Observation(
    self,
    Vector.tabulate(northM.size): vehicle =>
      val place    = Vector3(northM(vehicle), eastM(vehicle), -5)
      val velocity = Vector3(northMps(vehicle), eastMps(vehicle), 0)
      Seen(Kinematics(place, velocity, Quaternion.Identity, Vector3.Zero), Span.Zero, isPredicted = false)
    ,
    self,
    Vector.fill(northM.size)(Radians(headingRad)),
    Span.ofSeconds(elapsedS),
    0,
    MetresPerSecond(5),
    Metres(-5)
  )

package skein.lanes

import skein.policy.*
import skein.scenario.*
import skein.units.*

/** Four drones inspect a tower on a helix, and a fifth keeps its distance from the nearest of them.
  *
  * @param keepM distance that the fifth keeps
  */
final case class Tower(
    radiusM: Double = 8,
    heightM: Double = 30,
    climbMps: Double = 0.5,
    orbitMps: Double = 3,
    keepM: Double = 10,
    gainPerS: Double = 0.8
) extends Scenario:
  import Tower.*

  def agents: Vector[Agent] =
    val inspectors = Vector.tabulate(4): number =>
      val angle = number * math.Pi / 2
      val start = Vector3(radiusM * math.cos(angle), radiusM * math.sin(angle), -LowestM)
      Agent(
        s"Inspector${number + 1}",
        Role("Inspector"),
        MetresPerSecond(orbitMps + 2),
        start,
        Radians(angle + math.Pi / 2),
        Inspect(radiusM, -heightM, climbMps, orbitMps, gainPerS, start)
      )
    inspectors :+ Agent(
      "Keeper",
      Role("Keeper"),
      MetresPerSecond(8),
      Vector3(25, 0, -12),
      Radians(math.Pi),
      KeepDistance(keepM, gainPerS)
    )

  override def limits: Vector[Limit] =
    Vector(Limit.separation(Metres(3)), Limit.floor(Metres(2)), Limit.ceiling(Metres(heightM + 5)))

  override def series: Vector[Series]    = Vector(kept, apart)
  private val kept                       = Series.of("distance kept", "m", Kept(4))
  private val apart                      = Series.of("separation", "m", ApartInSpace)
  override def measures: Vector[Measure] = Vector(kept.mean("kept"), apart.least("closest"))

object Tower:
  private val LowestM = 6.0

  /** Follows a point that moves along the helix, and turns around at the top and at the bottom. The memory is
    * that point, whose altitude encodes the direction.
    */
  final case class Inspect(
      radiusM: Double,
      topDownM: Double,
      climbMps: Double,
      orbitMps: Double,
      gainPerS: Double,
      start: Vector3
  ) extends Policy:
    type Memory = Vector3

    def choose(seen: Observation, memory: Vector3): (Action, Vector3) =
      val forS       = seen.elapsed.toSeconds
      val angle      = orbitMps / radiusM * forS
      val (cos, sin) = (StrictMath.cos(angle), StrictMath.sin(angle))
      val down       = (memory.z - climbMps * forS).max(topDownM)
      val goal       = Vector3(memory.x * cos - memory.y * sin, memory.x * sin + memory.y * cos, down)
      val onward     = Vector3(-goal.y, goal.x, 0) * (orbitMps / radiusM)
      val wanted     = onward + (goal - seen.own.kinematics.positionNed) * gainPerS
      val most       = seen.cruise.value
      (Action.Velocity(wanted * (most / wanted.norm.max(most)), Yaw.Forward), goal)

  /** Keeps a distance from the nearest of all other vehicles. */
  final case class KeepDistance(keepM: Double, gainPerS: Double) extends Policy:
    type Memory = Unit
    def start: Unit = ()

    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      val here    = seen.own.kinematics.positionNed
      var nearest = Vector3(1e3, 0, 0)
      for other <- 0 until seen.count if other != seen.self do
        val way = seen.vehicles(other).kinematics.positionNed - here
        if way.norm < nearest.norm then nearest = way
      val distance = nearest.norm.max(1e-3)
      val speed    = (gainPerS * (distance - keepM)).max(-seen.cruise.value).min(seen.cruise.value)
      (Action.Velocity(nearest * (speed / distance)), ())

  /** Distance of the last vehicle from the nearest of the first ones, in space, m. */
  final case class Kept(keeper: Int) extends Quantity:
    def of(at: Positions): Double =
      var least = 1e9
      for other <- 0 until keeper do least = least.min(distance(at, keeper, other))
      least

  /** Smallest distance between two vehicles in space, m. */
  case object ApartInSpace extends Quantity:
    def of(at: Positions): Double =
      var least = 1e9
      for one <- 0 until at.count do
        for other <- 0 until one do least = least.min(distance(at, one, other))
      least

  private def distance(at: Positions, one: Int, other: Int) =
    val (north, east, down) = (
      at.northM(one) - at.northM(other),
      at.eastM(one) - at.eastM(other),
      at.downM(one) - at.downM(other)
    )
    StrictMath.sqrt(north * north + east * east + down * down)

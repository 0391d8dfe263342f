package ridge

import skein.policy.*
import skein.scenario.*
import skein.units.*

/** Two scouts climb over a ridge, side by side, and keep each other in view. The ridge runs from west to
  * east; its crest lies 60 m to the north.
  *
  * @param sideM distance of the two; the second begins to climb later than the first by `lateM`
  */
final case class OverTheRidge(
    crestM: Double = 30,
    widthM: Double = 20,
    aboveM: Double = 6,
    sideM: Double = 15,
    lateM: Double = 10,
    cruiseMps: Double = 5
) extends Scenario:
  private val land = Land(60, crestM, widthM)
  private val goal = 120.0

  def agents: Vector[Agent] =
    Vector("Scout1" -> 0.0, "Scout2" -> sideM).zipWithIndex.map:
      case ((name, eastM), place) =>
        val start = Vector3(-place * lateM, eastM, -(land.heightM(-place * lateM) + aboveM))
        val climb = ClimbOver(land, goal, eastM, aboveM, other = 1 - place)
        Agent(name, Role("Scout"), MetresPerSecond(cruiseMps), start, Radians(0), climb)

  override def limits: Vector[Limit] = Vector(
    Limit.separation(Metres(8)),
    Limit.ceiling(Metres(crestM + 3 * aboveM)),
    Limit.speed(MetresPerSecond(1.5 * cruiseMps)),
    Limit.least("height above the ground", "m", aboveM / 2)((tracks, scout) =>
      instant => tracks.altitudeM(scout, instant) - land.heightM(tracks.northM(scout)(instant))
    )
  )

  private val view  = Series.of("line of sight above the ground", "m", View(land), Some(Bound("in view", 0)))
  private val apart = Series.of("distance", "m", Apart)

  override def series: Vector[Series]    = Vector(view, apart)
  override def measures: Vector[Measure] = Vector(
    view.least("lowest view"),
    view.timeBelow("out of view", 0),
    apart.most("furthest apart"),
    Measure("over after", "s")(tracks =>
      tracks.instants.find(now => tracks.vehicles.forall(tracks.northM(_)(now) > goal - 3)).map(tracks.timeS)
    )
  )

  override def note: String = "Out of view: the ground is higher than the line between the two scouts."

  /** Ends when both have crossed the ridge. */
  override def isOver(known: Known): Boolean =
    known.vehicles.forall(_.kinematics.positionNed.x > goal - 2) || known.elapsed > Span.ofSeconds(90)

/** Minimum height of the line between the two above the ground, m: below 0 they cannot see each other. A
  * quantity is a function of the positions, so that searches can optimise it.
  */
final case class View(land: Land) extends Quantity:
  def of(at: Positions): Double = land.clearanceM(at.ned(0), at.ned(1))

/** Distance of the two, m. */
case object Apart extends Quantity:
  def of(at: Positions): Double = (at.ned(0) - at.ned(1)).norm

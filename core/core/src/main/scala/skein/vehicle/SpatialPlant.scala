package skein.vehicle

/** A vehicle's motion and readings in space: pure methods that are arithmetic on a case class of doubles,
  * like a [[Plant]]'s, and compiled to SIMD like them.
  *
  * North and east are counted from where the vehicle starts, and down from the origin of the world. It rests
  * until the first command.
  *
  * @tparam S the state: a case class of doubles, or of such
  */
trait SpatialPlant[S] extends PlantTiming:

  /** The state at rest at an altitude, m down. */
  def initial(downM: Double): S

  /** The state a time later.
    *
    * @param northMps commanded velocity, constant during the step
    * @param third the altitude to hold, m down, where `holds` is 1; the velocity down, m/s, where it is 0
    * @param dtS above 0, at most [[stepS]]
    */
  def step(state: S, northMps: Double, eastMps: Double, third: Double, holds: Double, dtS: Double): S

  def read(state: S): SpaceReading

/** A vehicle's position, m, and velocity, m/s, in a reading. */
final case class SpaceReading(
    northM: Double,
    eastM: Double,
    northMps: Double,
    eastMps: Double,
    downM: Double,
    downMps: Double
)

package skein.vehicle

/** A vehicle's motion and readings in space: pure methods that are arithmetic on a case class of doubles, and
  * compiled to SIMD, like those of a [[Plant]].
  *
  * North and east are counted from the vehicle's start, and down from the origin of the world. The vehicle
  * rests until the first command.
  *
  * @tparam S the state: a case class of doubles, or of such case classes
  */
trait SpatialPlant[S] extends PlantTiming:

  /** The state at rest at an altitude, m down from the origin. */
  def initial(downM: Double): S

  /** The state after `dtS`.
    *
    * @param northMps commanded velocity, constant during the step
    * @param third the altitude to hold, m down, if `holds` is 1; if it is 0, the velocity down, m/s
    * @param dtS duration of the step, s: above 0, at most [[stepS]]
    */
  def step(state: S, northMps: Double, eastMps: Double, third: Double, holds: Double, dtS: Double): S

  def read(state: S): SpaceReading

/** A [[SpatialPlant]] whose state can be corrected by readings, so that the loop `predictive`
  * ([[SpatialModel]]) can predict its flights. Its motion must not depend on its horizontal position.
  */
trait ObservedSpatialPlant[S] extends SpatialPlant[S]:

  /** The state corrected with a reading. Parts that a reading lacks stay unchanged.
    *
    * @param seen the reading; north and east may have any origin
    */
  def corrected(state: S, seen: SpaceReading): S

/** A vehicle's position, m, and velocity, m/s, in a reading. */
final case class SpaceReading(
    northM: Double,
    eastM: Double,
    northMps: Double,
    eastMps: Double,
    downM: Double,
    downMps: Double
)

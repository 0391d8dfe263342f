package skein.vehicle

/** A vehicle's motion and readings: pure methods that are arithmetic on a case class of doubles. The scalar
  * engine calls these methods; searches compile them to SIMD (`skein.forward.PlantResponse`).
  *
  * North and east are counted from the vehicle's start, where it rests until the first command.
  *
  * @tparam S the state: a case class of doubles, or of such case classes
  */
trait Plant[S] extends PlantTiming:

  def initial: S

  /** The state after `dtS`.
    *
    * @param northMps commanded velocity, constant during the step
    * @param dtS duration of the step, s: above 0, at most [[stepS]]
    */
  def step(state: S, northMps: Double, eastMps: Double, dtS: Double): S

  def read(state: S): PlaneReading

/** The step length of a plant, and the dead time of its commands. */
trait PlantTiming:
  /** Maximum step, s. A step begins when a command takes effect, and `stepS` after the begin of the previous
    * step.
    */
  def stepS: Double

  /** Time from a command's arrival until the vehicle follows it, s. */
  def deadTimeS: Double = 0

/** A plant whose state can be corrected by readings, so that `skein identify` and the loop `predictive`
  * ([[PlantModel]]) can predict its flights. Its motion must not depend on its position.
  */
trait ObservedPlant[S] extends Plant[S]:

  /** The state corrected with a reading. Parts that a reading lacks (a steering angle, an integrator) stay
    * unchanged.
    *
    * @param seen the reading; north and east may have any origin
    */
  def corrected(state: S, seen: PlaneReading): S

/** A vehicle's horizontal position, m, and velocity, m/s, in a reading. */
final case class PlaneReading(northM: Double, eastM: Double, northMps: Double, eastMps: Double)

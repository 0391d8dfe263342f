package skein.vehicle

/** A vehicle's motion and readings: pure methods that are arithmetic on a case class of doubles. The scalar
  * engine calls them; for searches they are compiled to SIMD unchanged (`skein.forward.PlantResponse`).
  *
  * North and east are counted from where the vehicle starts. It rests there until the first command.
  *
  * @tparam S the state: a case class of doubles, or of such
  */
trait Plant[S] extends PlantTiming:

  def initial: S

  /** The state a time later.
    *
    * @param northMps commanded velocity, constant during the step
    * @param dtS above 0, at most [[stepS]]
    */
  def step(state: S, northMps: Double, eastMps: Double, dtS: Double): S

  def read(state: S): PlaneReading

/** How finely a plant is simulated, and how long its commands wait. */
trait PlantTiming:
  /** Longest step, s. Steps begin when a command takes effect, and every `stepS` after that. */
  def stepS: Double

  /** Time from a command's arrival until the vehicle follows it, s. */
  def deadTimeS: Double = 0

/** A plant whose state can be corrected by a reading, so that its flights can be predicted from readings: by
  * `skein identify` and by the loop `predictive` ([[PlantModel]]). Its motion does not depend on where it is.
  */
trait ObservedPlant[S] extends Plant[S]:

  /** The state corrected by a reading; what a reading does not contain (a steering angle, an integrator)
    * stays.
    *
    * @param seen north and east from any origin
    */
  def corrected(state: S, seen: PlaneReading): S

/** A vehicle's horizontal position, m, and velocity, m/s, in a reading. */
final case class PlaneReading(northM: Double, eastM: Double, northMps: Double, eastMps: Double)

package skein.vehicle

/** How a vehicle moves and what is read of it, written once: pure methods that are arithmetic on a case class
  * of doubles. The scalar engine calls them; for searches they are compiled to SIMD as they stand
  * (`skein.forward.PlantResponse`).
  *
  * North and east are counted from where the vehicle starts. It rests there until the first command.
  *
  * @tparam S the state: a case class of doubles, or of such
  */
trait Plant[S]:

  /** At the start. */
  def initial: S

  /** The state a time later.
    *
    * @param northMps commanded velocity, which stands for that time
    * @param dtS above 0, at most [[stepS]]
    */
  def step(state: S, northMps: Double, eastMps: Double, dtS: Double): S

  /** What is read of it. */
  def read(state: S): PlaneReading

  /** The longest step, s. Steps begin when a command begins to act, and after every such time. */
  def stepS: Double

  /** From a command's arrival until the vehicle follows it, s. */
  def deadTimeS: Double = 0

/** A plant whose state can be set right by a reading, so that flights of it can be predicted from what was
  * read: by `skein identify` and by the loop `predictive` ([[PlantModel]]). Its motion does not depend on
  * where it is.
  */
trait ObservedPlant[S] extends Plant[S]:

  /** The state with what is read of it replaced; what a reading does not tell (a steering angle, an
    * integrator) stays.
    *
    * @param seen north and east from any origin
    */
  def corrected(state: S, seen: PlaneReading): S

/** Horizontal position, m, and velocity, m/s, as they are read of a vehicle. */
final case class PlaneReading(northM: Double, eastM: Double, northMps: Double, eastMps: Double)

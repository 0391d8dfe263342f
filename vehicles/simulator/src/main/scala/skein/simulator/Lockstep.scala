package skein.simulator

import skein.units.Instant

/** Something that physics stops for at certain times, and may have to wait for. */
private[simulator] trait Lockstep:
  /** Whether physics stands still. */
  def isWaiting: Boolean

  /** Where it must stop next, if it may run up to this time; None: nowhere. */
  def stop(until: Instant): Option[Instant]

  /** It stands at such a stop. */
  def reached(): Unit

  /** Where it is to run now, whatever the clock says; None: as far as that says. */
  def goal: Option[Instant]

  /** The time now, by the clock that the simulation is told of. */
  def told(at: Instant): Unit

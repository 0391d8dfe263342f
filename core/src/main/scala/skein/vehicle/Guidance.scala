package skein.vehicle

import skein.signal.Kinematics
import skein.units.Span

/** What a command makes of where its vehicle is: a goal for the flight controller. A [[Setpoint]] is one that never
  * changes.
  */
trait Guidance:
  def setpoint(now: Kinematics): Setpoint

  /** Time between two goals; absent where one is enough. */
  def period: Option[Span]

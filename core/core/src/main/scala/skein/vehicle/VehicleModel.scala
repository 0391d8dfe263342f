package skein.vehicle

import skein.signal.Kinematics
import skein.units.*

/** Carries what was read of one vehicle forward in time. Pure: a state is a value, also where the model
  * beneath is mutable.
  *
  * A state may hold more than a reading tells (rotors, integrators); [[corrected]] keeps that and replaces
  * the rest.
  *
  * @tparam S the state, immutable to its holder
  */
trait VehicleModel[S]:

  /** The state of a vehicle that was just seen for the first time. */
  def start(seen: Kinematics): S

  /** The state after `span` of flight under a setpoint. */
  def advanced(state: S, setpoint: Setpoint, span: Span): S

  /** The state when its vehicle was seen, `sinceSeen` after the last time, which was the start or a
    * correction.
    */
  def corrected(state: S, seen: Kinematics, sinceSeen: Span): S

  def kinematics(state: S): Kinematics

  /** The state of the vehicle's plant as numbers ([[PlantState]]), where a reading does not tell all of it.
    */
  def numbers: S => Vector[Double] = _ => Vector.empty

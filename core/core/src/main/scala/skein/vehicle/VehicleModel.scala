package skein.vehicle

import skein.signal.Kinematics
import skein.units.*

/** Predicts the state of one vehicle from its readings. Pure: a state is a value, even if the model's
  * implementation is mutable.
  *
  * A state may contain more than a reading, for example rotors and integrators; [[corrected]] keeps these and
  * replaces the rest.
  *
  * @tparam S the state, immutable to its user
  */
trait VehicleModel[S]:

  /** The state of a vehicle at its first reading. */
  def start(seen: Kinematics): S

  /** The state after `span` of flight under a setpoint. */
  def advanced(state: S, setpoint: Setpoint, span: Span): S

  /** The state corrected with a reading, `sinceSeen` after the previous reading. */
  def corrected(state: S, seen: Kinematics, sinceSeen: Span): S

  def kinematics(state: S): Kinematics

  /** The components of the state of the vehicle's plant ([[PlantState]]), if readings lack a part of it; else
    * empty.
    */
  def numbers: S => Vector[Double] = _ => Vector.empty

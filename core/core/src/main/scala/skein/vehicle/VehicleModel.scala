package skein.vehicle

import skein.signal.Kinematics
import skein.units.*

/** Predicts the state of one vehicle from its readings. Pure: a state is a value, even if the model beneath
  * is mutable.
  *
  * A state may hold more than a reading (rotors, integrators); [[corrected]] keeps that and replaces the
  * rest.
  *
  * @tparam S the state, immutable to its holder
  */
trait VehicleModel[S]:

  /** The state of a vehicle at its first reading. */
  def start(seen: Kinematics): S

  /** The state after `span` of flight under a setpoint. */
  def advanced(state: S, setpoint: Setpoint, span: Span): S

  /** The state corrected by a reading, `sinceSeen` after the previous reading. */
  def corrected(state: S, seen: Kinematics, sinceSeen: Span): S

  def kinematics(state: S): Kinematics

  /** The state of the vehicle's plant as numbers ([[PlantState]]), if readings do not contain the whole
    * state.
    */
  def numbers: S => Vector[Double] = _ => Vector.empty

package skein.loop

import skein.units.Expect
import skein.vehicle.{CarModel, ConstantTurn, ConstantVelocity, QuadrotorModel, TurnBelief, VehicleModel}

/** The knowledge that a vehicle's controller has of the other vehicles. */
enum Knowledge(val label: String):
  /** Their readings, the commands sent to them, and their policies. */
  case All extends Knowledge("all")

  /** Only their readings. A policy sees another vehicle's direction of motion as its heading. A loop that
    * predicts does so by [[Strangers]].
    */
  case Positions extends Knowledge("positions")

object Knowledge:
  def parse(text: String): Either[String, Knowledge] = Expect.oneOf(values, text)(_.label)

/** How a loop predicts the vehicles whose commands are not known. */
enum Strangers(val label: String):
  /** The turn between the last two readings continues; straight on if the deciding vehicle is predicted so,
    * too.
    */
  case Turn extends Strangers("turn")

  case Straight extends Strangers("straight")

  /** Multirotors by [[skein.vehicle.TurnBelief]], cars by their last turn. */
  case Belief extends Strangers("belief")

  /** @param own the vehicle's model if its commands were known */
  def model(own: VehicleModel[?]): VehicleModel[?] = this match
    case _ if own == ConstantVelocity => ConstantVelocity
    case Straight                     => ConstantVelocity
    case Turn                         => ConstantTurn
    case Belief                       => own match
        case _: CarModel               => ConstantTurn
        case quadrotor: QuadrotorModel => TurnBelief(quadrotor)
        case _                         => TurnBelief(QuadrotorModel.AirSim)

object Strangers:
  def parse(text: String): Either[String, Strangers] = Expect.oneOf(values, text)(_.label)

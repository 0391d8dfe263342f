package skein.loop

import skein.units.Expect
import skein.vehicle.{CarModel, ConstantTurn, ConstantVelocity, QuadrotorModel, TurnBelief, VehicleModel}

/** What the controller of a vehicle knows of the other ones. */
enum Knowledge(val label: String):
  /** Their readings, the commands sent to them, and their policies. */
  case All extends Knowledge("all")

  /** Their readings alone. A policy sees as another's heading the direction in which it moves. Where the loop
    * predicts, it predicts the others by [[Strangers]].
    */
  case Positions extends Knowledge("positions")

object Knowledge:
  def parse(text: String): Either[String, Knowledge] = Expect.oneOf(values, text)(_.label)

/** How a loop predicts the vehicles whose commands are not known. */
enum Strangers(val label: String):
  /** The turn of the last two readings goes on; straight on where the own vehicle is predicted so, too. */
  case Turn extends Strangers("turn")

  case Straight extends Strangers("straight")

  /** Multirotors by [[skein.vehicle.TurnBelief]], cars by their last turn. */
  case Belief extends Strangers("belief")

  /** @param own the model of the vehicle if its commands were known */
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

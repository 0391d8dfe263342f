package skein.policy

import skein.units.*

/** An [[Action]] whose components have any type, for example nodes of a formula.
  *
  * @param numbers the components of the kind, in its order, then that of the yaw, if it has one
  */
private[skein] final case class GraphAction[A](
    kind: GraphAction.Kind,
    numbers: Vector[A],
    yaw: GraphAction.YawKind
):
  def action(value: A => Double): Action =
    val of   = numbers.map(value)
    def last = of(kind.arity)
    val turn = yaw match
      case GraphAction.YawKind.Still   => Yaw.Still
      case GraphAction.YawKind.Forward => Yaw.Forward
      case GraphAction.YawKind.Towards => Yaw.Towards(Radians(last))
      case GraphAction.YawKind.Turning => Yaw.Turning(last)
    def place = Vector3(of(0), of(1), of(2))
    kind match
      case GraphAction.Kind.Along =>
        Action.Along(Radians(of(0)), MetresPerSecond(of(1)), Metres(of(2)), turn)
      case GraphAction.Kind.VelocityAt => Action.VelocityAt(of(0), of(1), Metres(of(2)), turn)
      case GraphAction.Kind.Velocity   => Action.Velocity(place, turn)
      case GraphAction.Kind.Position   => Action.Position(place, MetresPerSecond(of(3)), turn)
      case GraphAction.Kind.Turn       => Action.Turn(turn)
      case GraphAction.Kind.Attitude   =>
        Action.Attitude(Radians(of(0)), Radians(of(1)), Radians(of(2)), of(3))
      case GraphAction.Kind.Hover => Action.Hover
      case GraphAction.Kind.Land  => Action.Land

private[skein] object GraphAction:
  /** The kinds of actions, each with its number of components.
    *
    * @param word the kind's name in a scenario file
    */
  enum Kind(val word: String, val arity: Int, val hasYaw: Boolean):
    // Heading, speed, down.
    case Along extends Kind("along", 3, true)

    // North, east, down: two kinds of velocity, and a position.
    case VelocityAt extends Kind("velocity-at", 3, true)
    case Velocity   extends Kind("velocity", 3, true)

    // North, east, down, speed.
    case Position extends Kind("position", 4, true)
    case Turn     extends Kind("turn", 0, true)

    // Roll, pitch, yaw, thrust.
    case Attitude extends Kind("attitude", 4, false)
    case Hover    extends Kind("hover", 0, false)
    case Land     extends Kind("land", 0, false)

  enum YawKind(val word: String, val arity: Int):
    case Still   extends YawKind("still", 0)
    case Forward extends YawKind("forward", 0)
    case Towards extends YawKind("towards", 1)
    case Turning extends YawKind("turning", 1)

package skein.lanes.gpu

import skein.formula.{Node, Trace}

/** First-order lag, exactly integrated between commands, as expressions. The state is that at the last
  * command that acted: position, the velocity asked for, and the velocity's error, which dies away.
  */
private[lanes] object LagExpressions:
  /** Inputs: the state, in the order of [[act]]'s outputs, and the direction commanded. */
  val State: Int            = 6
  private final val X       = 0
  private final val AskedX  = 2
  private final val ErrorX  = 4
  private final val Command = State

  /** Parameters: how long ago the last command acted, s; how far an error carries since, over the error, s;
    * what remains of it; and the speed of a direction of length 1, m/s.
    */
  private final val Since   = 0
  private final val Carries = 1
  private final val Remains = 2
  val Speed: Int            = 3

  private val trace = Trace()
  import trace.{add, input, mul, param, sub}

  // Of each of the two axes.
  private def placed(axis: Int) = add(
    mul(input(ErrorX + axis), param(Carries)),
    add(mul(input(AskedX + axis), param(Since)), input(X + axis))
  )
  private def moved(axis: Int) =
    add(mul(input(ErrorX + axis), param(Remains)), input(AskedX + axis))
  private def asked(axis: Int) = mul(input(Command + axis), param(Speed))
  private def error(axis: Int) =
    add(mul(input(ErrorX + axis), param(Remains)), sub(input(AskedX + axis), asked(axis)))

  private def both(of: Int => Node) = Vector(of(0), of(1))

  /** North and east, m. */
  val position: Vector[Node] = both(placed)

  /** North and east, m/s. */
  val velocity: Vector[Node] = both(moved)

  /** The state as a command acts. */
  val act: Vector[Node] = both(placed) ++ both(asked) ++ both(error)

package skein.formula

import scala.collection.mutable
import skein.formula.Op.*

/** Rewrites an expression for SIMD, where an arc tangent costs as much as twenty products. The result is
  * cheaper, and equal except for rounding.
  *
  *   - The sine and cosine of an angle made of arc tangents, quarter turns and angles of known direction
  *     become products of directions; such an angle wrapped to one turn needs a single arc tangent.
  *   - A part that both branches of a condition contain is computed once.
  *   - A part that depends only on parameters becomes a parameter ([[derived]]), which is computed once, in
  *     double precision.
  *
  * @param source trace of the old expression
  * @param target trace of the new expression
  * @param leaf node that replaces an input
  * @param direction cosine and sine of an input that is an angle, if known
  * @param parameter node of a parameter of the new expression, by its index
  */
final class Angles(
    source: Trace,
    target: Trace,
    leaf: Int => Node,
    direction: Int => Option[(Node, Node)],
    parameter: Int => Node
):
  private val done       = mutable.HashMap.empty[Node, Node]
  private val plain      = mutable.HashMap.empty[Node, Node]
  private val directions = mutable.HashMap.empty[Node, Option[Direction]]
  private val fixed      = mutable.HashMap.empty[Node, Boolean]
  private val parameters = mutable.LinkedHashMap.empty[Node, Node]

  /** The new expression's parameters as nodes of the old one, in their order. */
  def derived: Vector[Node] = parameters.keys.toVector

  /** A direction, as a vector (x, y) of any length. */
  private final case class Direction(x: Node, y: Node, isUnit: Boolean)

  def convert(node: Node): Node =
    land(node)
    inner(node)

  /** Moves parts that both branches of a condition contain out of the condition, and combines factors that
    * are constant or depend only on parameters.
    */
  def factored(node: Node): Node =
    for each <- Trace.landings(node) do plained(each): Unit
    plained(node)

  def cosSin(node: Node): (Node, Node) =
    land(node)
    cosSinOf(node)

  private def land(node: Node): Unit = for each <- Trace.landings(node) do
    if isFixed(each) then () else inner(each): Unit

  private def inner(node: Node): Node = done.getOrElseUpdate(node, converted(node))

  private def plained(node: Node): Node = plain.getOrElseUpdate(
    node,
    node.op match
      case Const | Input | Param | Always => node
      case Where                          =>
        val Vector(condition, a, b) = node.args.map(plained)
        choose(source, condition, a, b)
      case Div if node.args(1).isConst =>
        scaled(plained(node.args(0)), 1 / node.args(1).value)
      case Mul if node.args(1).isConst  => scaled(plained(node.args(0)), node.args(1).value)
      case Mul if node.args(0).isConst  => scaled(plained(node.args(1)), node.args(0).value)
      case Mul if isFixed(node.args(0)) => scaledBy(plained(node.args(1)), plained(node.args(0)))
      case Mul if isFixed(node.args(1)) => scaledBy(plained(node.args(0)), plained(node.args(1)))
      case _                            => source.again(node, node.args.map(plained))
  )

  private def scaled(node: Node, by: Double): Node =
    if node.op == Mul && node.args(1).isConst then
      source.mul(node.args(0), source.const(node.args(1).value * by))
    else source.mul(node, source.const(by))

  /** A product with a factor that depends only on parameters: rounded like a product with a constant of this
    * value.
    */
  private def scaledBy(node: Node, by: Node): Node =
    if node.op == Mul && node.args(1).isConst then source.mul(node.args(0), source.mul(node.args(1), by))
    else source.mul(node, by)

  private def cosSinOf(node: Node): (Node, Node) = directionOf(node) match
    case Some(way) => unit(way)
    case None      => (target.unary(Cos, inner(node)), target.unary(Sin, inner(node)))

  private def converted(node: Node): Node =
    if isFixed(node) && !node.isConst && !node.op.isCondition && node.op != Always then
      parameters.getOrElseUpdate(node, parameter(parameters.size))
    else
      node.op match
        case Input => leaf(node.index)
        case Sin   => cosSinOf(node.args(0))._2
        case Cos   => cosSinOf(node.args(0))._1
        case Add   => plus(inner(node.args(0)), inner(node.args(1)))
        case Mul   => times(inner(node.args(0)), inner(node.args(1)))
        // Only the side is needed, not the angle.
        case Signum if angleOf(node.args(0)).isDefined => target.unary(Signum, angleOf(node.args(0)).get.y)
        case Lt if sizeOf(node.args(1)).isDefined && isFixed(node.args(0)) =>
          target.lt(sizeOf(node.args(1)).get.x, cosine(node.args(0)))
        case Le if sizeOf(node.args(1)).isDefined && isFixed(node.args(0)) =>
          target.le(sizeOf(node.args(1)).get.x, cosine(node.args(0)))
        case Lt if sizeOf(node.args(0)).isDefined && isFixed(node.args(1)) =>
          target.lt(cosine(node.args(1)), sizeOf(node.args(0)).get.x)
        case Le if sizeOf(node.args(0)).isDefined && isFixed(node.args(1)) =>
          target.le(cosine(node.args(1)), sizeOf(node.args(0)).get.x)
        case Where if isSideOrElse(node) =>
          val y         = inner(node.args(2).args(0))
          val otherwise = target.where(target.lt(y, target.const(0)), target.const(-1), inner(node.args(1)))
          target.where(target.lt(target.const(0), y), target.const(1), otherwise)
        case Remainder if isTurn(node.args(1)) =>
          directionOf(node.args(0)) match
            case Some(way) => target.binary(Atan2, way.y, way.x)
            case None      => target.again(node, node.args.map(inner))
        case Where => choose(inner(node.args(0)), inner(node.args(1)), inner(node.args(2)))
        case _     => target.again(node, node.args.map(inner))

  /** Whether a node is the sign of a number, except that it has another value where the number is 0. */
  private def isSideOrElse(node: Node) =
    val Vector(condition, _, sign) = node.args
    sign.op == Signum && condition.op == Eq && condition.args(0) == sign.args(0) && condition.args(1).is(0)

  /** Direction of an angle that is known to be at most half a turn; None for other nodes. */
  private def angleOf(node: Node): Option[Direction] = node.op match
    case Remainder if isTurn(node.args(1)) => directionOf(node.args(0))
    case _                                 => None

  /** Direction of the angle in an absolute value, if its vector has length 1; None for other nodes. */
  private def sizeOf(node: Node): Option[Direction] =
    if node.op == Abs then angleOf(node.args(0)).filter(_.isUnit) else None

  /** Cosine of a parameter with which an angle's absolute value is compared. */
  private def cosine(angle: Node): Node =
    val within = source.binary(Max, source.const(0), source.binary(Min, source.const(math.Pi), angle))
    inner(source.unary(Cos, within))

  private def isTurn(node: Node) = node.isConst && math.abs(node.value - 2 * math.Pi) < 1e-9

  private def isFixed(node: Node): Boolean = fixed.getOrElseUpdate(
    node,
    node.op match
      case Input                  => false
      case Const | Param | Always => true
      case _                      => node.args.forall(isFixed)
  )

  private def choose(condition: Node, a: Node, b: Node): Node = choose(target, condition, a, b)

  /** Chooses one of two numbers by a condition; their common parts are computed once. */
  private def choose(in: Trace, condition: Node, a: Node, b: Node): Node =
    def of(x: Node, y: Node): Node = choose(in, condition, x, y)
    if a == b then a
    else if a.op == b.op && a.args.nonEmpty && (a.op.isDear || a.op == Neg) then
      in.again(a, a.args.zip(b.args).map(of))
    else
      val (partsOfA, partsOfB) = (parts(a), parts(b))
      val shared               = partsOfA.filter(part => !part.isConst && partsOfB.contains(part))
      if shared.isEmpty then in.where(condition, a, b)
      else
        val rest = of(sum(in, partsOfA.diff(shared)), sum(in, partsOfB.diff(shared)))
        if rest.is(0) then sum(in, shared) else in.add(sum(in, shared), rest)

  private def parts(of: Node): Vector[Node] =
    if of.op == Add then parts(of.args(0)) ++ parts(of.args(1)) else Vector(of)

  private def sum(in: Trace, of: Vector[Node]): Node = of.reduceOption(in.add).getOrElse(in.const(0))

  /** Adds two numbers; the sign of a zero result is arbitrary. */
  private def plus(a: Node, b: Node): Node = if a.is(0) then b else if b.is(0) then a else target.add(a, b)

  private def times(a: Node, b: Node): Node =
    if a.is(0) || b.is(0) then target.const(0) else target.mul(a, b)

  private def directionOf(node: Node): Option[Direction] = directions.getOrElseUpdate(node, found(node))

  private def found(node: Node): Option[Direction] = node.op match
    case Input => direction(node.index).map((cos, sin) => Direction(cos, sin, isUnit = true))
    case Const =>
      def clean(value: Double) = target.const(if math.abs(value) < 1e-15 then 0 else value)
      Some(Direction(clean(StrictMath.cos(node.value)), clean(StrictMath.sin(node.value)), isUnit = true))
    case Neg => directionOf(node.args(0)).map(way => way.copy(y = target.neg(way.y)))
    // One of two known angles is added: both sums are computed, since quarter turns cost nothing.
    case Add if isChoiceOfQuarters(node.args(1)) => either(node.args(0), node.args(1))
    case Add if isChoiceOfQuarters(node.args(0)) => either(node.args(1), node.args(0))
    case Add                                     => both(node).map(turned(_, _))
    case Sub   => both(node).map((a, b) => turned(a, b.copy(y = target.neg(b.y))))
    case Where =>
      for
        a <- directionOf(node.args(1))
        b <- directionOf(node.args(2))
      yield
        val condition = inner(node.args(0))
        Direction(choose(condition, a.x, b.x), choose(condition, a.y, b.y), a.isUnit && b.isUnit)
    case Atan2 => Some(Direction(inner(node.args(1)), inner(node.args(0)), isUnit = false))
    case Remainder if isTurn(node.args(1)) => directionOf(node.args(0))
    case Asin                              =>
      val sine = inner(node.args(0))
      Some(Direction(other(sine), sine, isUnit = true))
    case Acos =>
      val cosine = inner(node.args(0))
      Some(Direction(cosine, other(cosine), isUnit = true))
    case Mul if isSign(node.args(0)) => mirrored(node.args(0), node.args(1))
    case Mul if isSign(node.args(1)) => mirrored(node.args(1), node.args(0))
    case _                           => None

  private def isChoiceOfQuarters(node: Node) = node.op == Where && node.args.tail.forall: each =>
    each.isConst && math.abs(math.IEEEremainder(each.value, math.Pi / 2)) < 1e-9

  private def either(angle: Node, by: Node): Option[Direction] =
    val Vector(condition, a, b) = by.args
    directionOf(source.where(condition, source.add(angle, a), source.add(angle, b)))

  private def both(node: Node): Option[(Direction, Direction)] =
    directionOf(node.args(0)).zip(directionOf(node.args(1)))

  private def turned(a: Direction, b: Direction): Direction = Direction(
    plus(times(a.x, b.x), target.neg(times(a.y, b.y))),
    plus(times(a.y, b.x), times(a.x, b.y)),
    a.isUnit && b.isUnit
  )

  private def mirrored(sign: Node, angle: Node): Option[Direction] = directionOf(angle).map: way =>
    val by = inner(sign)
    if neverZero(sign) then way.copy(y = times(by, way.y))
    else
      val none = target.equal(by, target.const(0))
      Direction(
        target.where(none, target.const(1), way.x),
        times(by, way.y),
        way.isUnit
      )

  private def isSign(node: Node): Boolean = node.op match
    case Const  => node.value == 1 || node.value == -1 || node.value == 0
    case Signum => true
    case Neg    => isSign(node.args(0))
    case Where  => isSign(node.args(1)) && isSign(node.args(2))
    case _      => false

  private def neverZero(node: Node): Boolean = node.op match
    case Const => node.value != 0
    case Neg   => neverZero(node.args(0))
    case Where => neverZero(node.args(1)) && neverZero(node.args(2))
    case _     => false

  private def other(part: Node): Node =
    val one = target.const(1)
    target.unary(Sqrt, target.binary(Max, target.const(0), target.sub(one, target.mul(part, part))))

  /** Cosine and sine of a direction; those of angle 0 if its length is 0. */
  private def unit(way: Direction): (Node, Node) =
    if way.isUnit then (way.x, way.y)
    else
      val one    = target.const(1)
      val square = target.add(target.mul(way.x, way.x), target.mul(way.y, way.y))
      val none   = target.equal(square, target.const(0))
      val scale  = target.div(one, target.unary(Sqrt, target.where(none, one, square)))
      (target.mul(target.where(none, one, way.x), scale), target.mul(way.y, scale))

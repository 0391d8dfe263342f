package skein.simd

import scala.collection.mutable
import skein.formula.{Node, Op}

/** One loop over the worlds.
  *
  * @param computes nodes to compute, in this order
  * @param loads nodes that are loaded from scratch, with their slots
  * @param stores nodes that are stored in scratch, with their slots
  * @param outputs nodes that are outputs, with the outputs' indices
  */
private final case class Pass(
    computes: Vector[Node],
    loads: Map[Node, Int],
    stores: Vector[(Node, Int)],
    outputs: Vector[(Node, Int)]
)

/** Splits a long expression into passes that the JIT compiler handles well. */
private object Passes:
  // Chosen by measurement (`PolicyBenchmark`): above either limit, constants are loaded from memory in every
  // round.

  /** Maximum number of vector operations in one pass. */
  private val Most = 50

  /** Maximum number of constants in one pass, of 32 registers. */
  private val MostConstants = 20

  // The limits if inputs and outputs are rows of few arrays, whose addresses need few registers: a step with
  // drag and two lags takes 210 ns in one pass and 250 to 300 in two; the quadrotor's 400 operations reach
  // 119 M steps per second in four passes, and 95 M in eight of 60. With 30 constants, a car's position takes
  // 50 ns, with 26 constants 34 ns, and its step 3 % less.
  private val MostOfRows          = 140
  private val MostConstantsOfRows = 26

  // Costs of a pass and of loading a value, relative to storing one.
  private val PassCost  = 8.0
  private val FetchCost = 0.5

  /** Splits expressions.
    *
    * @param ofRows whether inputs and outputs are rows of few arrays
    */
  def of(outputs: Vector[Node], ofRows: Boolean): Vector[Pass] =
    val (most, mostConstants) = if ofRows then (MostOfRows, MostConstantsOfRows) else (Most, MostConstants)
    val products              = Products(outputs)
    import products.{argsOf, computed}
    val ends   = cut(computed, argsOf, most, mostConstants)
    val number = ends.size - 1
    val passOf = mutable.HashMap.empty[Node, Int]
    for ((first, end), pass) <- (0 +: ends).zip(ends).zipWithIndex; at <- first until end do
      passOf(computed(at)) = pass
    val ofPass = computed.groupBy(passOf).withDefaultValue(Vector.empty)
    val needs  = Vector.tabulate(number + 1): pass =>
      ofPass(pass).flatMap(argsOf).distinct.filter(arg =>
        !arg.op.isLeaf && passOf(arg) < pass
      )
    // A pass that needs another pass's condition computes it again, because masks cannot be stored.
    val again   = needs.map(conditionsOf)
    val numbers = needs
      .zip(again)
      .map((each, again) => (each ++ again.flatMap(argsOf)).filterNot(_.op.isCondition).distinct)
    val lastUse = mutable.LinkedHashMap.empty[Node, Int]
    for (each, pass) <- numbers.zipWithIndex; node <- each if !node.op.isLeaf do lastUse(node) = pass
    val places = placed(lastUse, passOf, number + 1)
    Vector.tabulate(number + 1): pass =>
      val own    = ofPass(pass)
      val loaded = numbers(pass).filter(node => !node.op.isLeaf && passOf(node) < pass)
      Pass(
        again(pass) ++ own,
        loaded.map(node => node -> places(node)).toMap,
        own.filter(places.contains).map(node => node -> places(node)),
        outputs.zipWithIndex.filter((node, _) => passOf.getOrElse(node, 0) == pass)
      )

  /** The conditions among the nodes, and the conditions on which these depend, each once and arguments before
    * their users.
    */
  private def conditionsOf(nodes: Vector[Node]): Vector[Node] =
    val found                  = mutable.LinkedHashSet.empty[Node]
    def find(node: Node): Unit = if node.op.isCondition && !found(node) then
      node.args.foreach(find)
      found += node
    nodes.foreach(find)
    found.toVector

  /** Divides nodes, in this order, into passes that store and load as few values as possible.
    *
    * @return the end of each pass, as an index in the order
    */
  private def cut(
      order: Vector[Node],
      argsOf: Node => Vector[Node],
      most: Int,
      mostConstants: Int
  ): Vector[Int] =
    val count   = order.size
    val placeOf = order.zipWithIndex.toMap
    val args    = order.map(argsOf(_).filterNot(arg => arg.isConst || arg.op == Op.Always))
    val costs   = order.map(LaneCosts.of)
    val needs   = order.map(LaneCosts.constantsOf)
    val lastUse = Array.ofDim[Int](count)
    for (of, at) <- args.zipWithIndex; arg <- of if !arg.op.isLeaf do lastUse(placeOf(arg)) = at
    val best = Array.fill(count + 1)(Double.PositiveInfinity)
    val from = Array.ofDim[Int](count + 1)
    best(0) = 0
    for end <- 1 to count do
      val fetched    = mutable.HashSet.empty[Node]
      val constants  = mutable.HashSet.empty[Any]
      var size, laid = 0
      var first      = end
      var fits       = true
      while first > 0 && fits do
        first -= 1
        val node = order(first)
        size += costs(first)
        constants ++= needs(first)
        fits = first == end - 1 || size <= most && constants.size <= mostConstants
        if fits then
          if !node.op.isLeaf then fetched -= node
          fetched ++= args(first)
          if lastUse(first) >= end && !node.op.isCondition then laid += 1
          val cost = best(first) + PassCost + fetched.size * FetchCost + laid
          if cost < best(end) then
            best(end) = cost
            from(end) = first
    Iterator.iterate(count)(from(_)).takeWhile(_ > 0).toVector.reverse

  /** Assigns a scratch slot to each value from its computation to its last use. Slots are reused as soon as
    * they are free, so that all stay in a near cache. A pass loads before it stores.
    */
  private def placed(
      lastUse: collection.Map[Node, Int],
      passOf: collection.Map[Node, Int],
      passes: Int
  ): Map[Node, Int] =
    val nodes        = lastUse.keysIterator.toVector
    val (made, used) = (nodes.groupBy(passOf), nodes.groupBy(lastUse))
    val places       = mutable.HashMap.empty[Node, Int]
    val free         = mutable.Stack.empty[Int]
    var most         = 0
    for pass <- 0 until passes do
      for node <- used.getOrElse(pass, Nil) do free.push(places(node))
      for node <- made.getOrElse(pass, Nil) do
        places(node) =
          if free.nonEmpty then free.pop()
          else
            most += 1
            most - 1
    places.toMap

/** Estimated costs of an operation in SIMD code. */
private object LaneCosts:
  /** Approximate number of vector operations. */
  def of(node: Node): Int = node.op match
    case Op.Sin | Op.Cos                   => 16
    case Op.Atan2 | Op.Atan                => 26
    case Op.Exp                            => 16
    case Op.Tanh                           => 19
    case Op.Asin | Op.Acos                 => 14
    case Op.Hypot                          => 3
    case Op.Remainder | Op.Floor | Op.Ceil => 4
    case Op.Signum                         => 4
    case _                                 => 1

  /** Constants that an operation needs in registers. */
  def constantsOf(node: Node): Set[Any] =
    def named(op: Op, count: Int) = Set.tabulate[Any](count)(i => (op, i))
    val own                       = node.op match
      case Op.Sin | Op.Cos              => named(Op.Sin, 15)
      case Op.Atan2 | Op.Atan           => named(Op.Atan2, 11)
      case Op.Exp | Op.Tanh             => named(Op.Exp, 12)
      case Op.Asin | Op.Acos            => named(Op.Acos, 9)
      case Op.Remainder                 => named(Op.Remainder, 3)
      case Op.Floor | Op.Ceil | Op.Rint => named(Op.Remainder, 1)
      case _                            => Set.empty
    own ++ node.args.filter(_.isConst).map(_.value)

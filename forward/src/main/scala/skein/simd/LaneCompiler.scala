package skein.simd

import java.lang.classfile.{ClassFile, CodeBuilder}
import java.lang.constant.{ClassDesc, ConstantDescs, MethodTypeDesc}
import java.lang.invoke.MethodHandles
import java.lang.reflect.AccessFlag
import scala.collection.mutable
import skein.formula.{Node, Op, Untraceable}

/** Compiles expressions to a [[LaneFunction]]: straight passes over blocks of worlds, in which a number stays
  * in a register from where it is computed to where it is used. Elementary functions are the polynomials of
  * [[LaneMath]], written out, so that every lane computes the same bits on every machine; products are fused
  * with sums.
  *
  * A pass calls the vector API alone and is no longer than the JVM's compiler takes in at once without boxing
  * vectors (see [[LaneMath]]). A longer expression becomes several passes; numbers that pass from one to
  * another are laid by in scratch, which stays in the first-level cache.
  */
object LaneCompiler:

  /** @param inputs how many there are
    * @param outputs what is computed
    * @param differences so many of the first inputs are differences of two arrays' numbers; what is taken
    *   away stands in the arrays behind those of the outputs
    * @param parameters how many each world has; 0: all worlds have the same
    * @param places of the inputs and then of the outputs, where several stand in one array, one after the
    *   other: the array's number and the row in it; none: each has its own
    */
  def compile(
      inputs: Int,
      outputs: Vector[Node],
      differences: Int = 0,
      parameters: Int = 0,
      places: Vector[(Int, Int)] = Vector.empty
  ): LaneFunction =
    val passes  = Passes.of(outputs, ofRows = places.distinctBy(_._1).size < places.size)
    val self    = ClassDesc.of("skein.simd.CompiledLaneFunction")
    val scratch = passes.iterator.flatMap(_.stores).map(_._2 + 1).maxOption.getOrElse(0)
    val bytes   = ClassFile
      .of(ClassFile.DebugElementsOption.DROP_DEBUG)
      .build(
        self,
        builder =>
          builder
            .withSuperclass(Names.function)
            .withFlags(AccessFlag.FINAL, AccessFlag.SUPER)
            .withMethodBody(
              "<init>",
              ConstantDescs.MTD_void,
              0,
              code =>
                code.aload(0).invokespecial(Names.function, "<init>", ConstantDescs.MTD_void).return_(): Unit
            )
            .withMethodBody(
              "scratch",
              MethodTypeDesc.of(ConstantDescs.CD_int),
              ClassFile.ACC_PUBLIC,
              code => code.loadConstant(scratch * LaneFunction.COUNT).ireturn(): Unit
            )
            .withMethodBody(
              "apply",
              Names.apply,
              ClassFile.ACC_PUBLIC,
              code =>
                for pass <- passes.indices do
                  code.aload(1).aload(2).aload(3).aload(4).iload(5)
                  code.invokestatic(self, s"pass$pass", Names.apply)
                code.return_(): Unit
            )
          for (pass, number) <- passes.zipWithIndex do
            builder.withMethodBody(
              s"pass$number",
              Names.apply,
              ClassFile.ACC_STATIC,
              code =>
                PassCompiler(
                  code,
                  pass,
                  inputs,
                  differences,
                  inputs + outputs.size,
                  parameters,
                  places
                ).emit()
            ): Unit
      )
    val lookup = MethodHandles.lookup().defineHiddenClass(bytes, true)
    lookup.lookupClass.getDeclaredConstructor().newInstance().asInstanceOf[LaneFunction]

private object Names:
  def vector(name: String): ClassDesc = ClassDesc.of(s"jdk.incubator.vector.$name")
  val float: ClassDesc                = vector("FloatVector")
  val int: ClassDesc                  = vector("IntVector")
  val any: ClassDesc                  = vector("Vector")
  val mask: ClassDesc                 = vector("VectorMask")
  val species: ClassDesc              = vector("VectorSpecies")
  val operators: ClassDesc            = vector("VectorOperators")
  val comparison: ClassDesc           = vector("VectorOperators$Comparison")
  val binary: ClassDesc               = vector("VectorOperators$Binary")
  val associative: ClassDesc          = vector("VectorOperators$Associative")
  val function: ClassDesc             = ClassDesc.of("skein.simd.LaneFunction")
  val math: ClassDesc                 = ClassDesc.of("skein.simd.LaneMath")
  val floats: ClassDesc               = ConstantDescs.CD_float.arrayType
  val ints: ClassDesc                 = ConstantDescs.CD_int.arrayType

  val apply: MethodTypeDesc =
    MethodTypeDesc.of(ConstantDescs.CD_void, floats.arrayType, ints, floats, floats, ConstantDescs.CD_int)

/** Writes the bytecode of one pass. A vector is a local variable, given by its number.
  *
  * @param subtrahends where the arrays begin whose numbers are taken away from the first inputs
  */
private final class PassCompiler(
    code: CodeBuilder,
    pass: Pass,
    inputs: Int,
    differences: Int,
    subtrahends: Int,
    parameters: Int,
    places: Vector[(Int, Int)]
):
  import Names.*
  private val count          = LaneFunction.COUNT
  private val slots          = mutable.HashMap.empty[Node, Int]
  private val floatConstants = mutable.HashMap.empty[Int, Int]
  private val intConstants   = mutable.HashMap.empty[Int, Int]
  private val pairs          = mutable.HashMap.empty[Node, (Int, Int)]
  private val arrays         = mutable.HashMap.empty[Int, (Int, Int)]
  private val end            = 4
  private val world          = 5
  private var next           = 6

  private def fresh(): Int =
    next += 1
    next - 1

  def emit(): Unit =
    // Everything before the loop is found by writing the loop once for nothing.
    val rehearsal = ClassFile.of(
      ClassFile.StackMapsOption.DROP_STACK_MAPS,
      ClassFile.DeadCodeOption.KEEP_DEAD_CODE,
      ClassFile.DebugElementsOption.DROP_DEBUG
    )
    rehearsal.build(
      ClassDesc.of("skein.simd.Rehearsal"),
      builder =>
        builder.withMethodBody(
          "pass",
          Names.apply,
          ClassFile.ACC_STATIC,
          other =>
            val first = PassCompiler(other, pass, inputs, differences, subtrahends, parameters, places)
            first.body()
            other.return_()
            for array <- first.arrays.keys.toVector.sorted do arrays(array) = (fresh(), fresh())
            for bits <- first.floatConstants.keys.toVector.sorted do floatConstants(bits) = fresh()
            for value <- first.intConstants.keys.toVector.sorted do intConstants(value) = fresh()
        ): Unit
    ): Unit
    for (array, (place, offset)) <- arrays.toVector.sortBy(_._1) do
      code.aload(0).loadConstant(array).aaload().astore(place)
      code.aload(1).loadConstant(array).iaload().istore(offset)
    for (bits, place) <- floatConstants do
      code.getstatic(math, "SPECIES", species)
      code.loadConstant(java.lang.Float.intBitsToFloat(bits))
      code.invokestatic(float, "broadcast", MethodTypeDesc.of(float, species, ConstantDescs.CD_float))
      code.astore(place)
    for (value, place) <- intConstants do
      code.getstatic(math, "INTS", species)
      code.loadConstant(value)
      code.invokestatic(int, "broadcast", MethodTypeDesc.of(int, species, ConstantDescs.CD_int))
      code.astore(place)
    val (head, over) = (code.newLabel(), code.newLabel())
    code.iconst_0().istore(world)
    code.labelBinding(head).iload(world).iload(end).if_icmpge(over)
    body()
    code.iload(world).getstatic(math, "LANES", ConstantDescs.CD_int).iadd().istore(world)
    code.goto_(head).labelBinding(over).return_(): Unit

  private def body(): Unit =
    for (node, place) <- pass.loads do slots(node) = loaded(3, place * count)
    for node <- pass.computes if !isLeaf(node) do computed(node): Unit
    for (node, place) <- pass.stores do store(of(node), 3, place * count)
    for (node, output) <- pass.outputs do storeTo(of(node), inputs + output)

  private def isLeaf(node: Node) = node.op match
    case Op.Const | Op.Input | Op.Param | Op.Always => true
    case _                                          => false

  /** Where a node's vector or mask is. */
  private def of(node: Node): Int = node.op match
    case Op.Const => constant(node.value.toFloat)
    case _        => slots.getOrElseUpdate(node, computed(node))

  private def computed(node: Node): Int =
    slots.getOrElse(
      node, {
        val place = write(node)
        slots(node) = place
        place
      }
    )

  private def write(node: Node): Int =
    def a = of(node.args(0))
    def b = of(node.args(1))
    node.op match
      case Op.Const => constant(node.value.toFloat)
      case Op.Input =>
        val number = node.index
        if number < differences then two("sub", input(number), input(subtrahends + number)) else input(number)
      case Op.Param =>
        if parameters == 0 then shared(node.index) else parameter(node.index)
      case Op.Neg  => unary("neg", a)
      case Op.Abs  => unary("abs", a)
      case Op.Sqrt => unary("sqrt", a)
      case Op.Add  =>
        Passes.factor(node) match
          case Some(product) if !slots.contains(product) =>
            val other = if node.args(0) == product then node.args(1) else node.args(0)
            fma(of(product.args(0)), of(product.args(1)), of(other))
          case _ => two("add", a, b)
      case Op.Sub   => two("sub", a, b)
      case Op.Mul   => two("mul", a, b)
      case Op.Div   => two("div", a, b)
      case Op.Min   => extreme("LT", node)
      case Op.Max   => extreme("GT", node)
      case Op.Where => blend(of(node.args(2)), b, a)
      case Op.Lt    => compare("LT", a, b)
      case Op.Le    => compare("LE", a, b)
      case Op.Eq    => compare("EQ", a, b)
      case Op.Not   => maskUnary("not", a)
      case Op.And   => maskTwo("and", a, b)
      case Op.Or    => maskTwo("or", a, b)
      case Op.Sin   => sinCos(node.args(0))._1
      case Op.Cos   => sinCos(node.args(0))._2
      case Op.Atan2 => atan2(a, b)
      case Op.Atan  => atan2(a, constant(1f))
      case Op.Hypot =>
        val (x, y) = (a, b)
        unary("sqrt", fma(x, x, two("mul", y, y)))
      case Op.Exp   => exp(limited("GT", limited("LT", a, constant(88f)), constant(-87f)))
      case Op.Tanh  => tanh(a)
      case Op.Acos  => acos(node.args(0))
      case Op.Asin  => two("sub", constant(1.57079633f), acos(node.args(0)))
      case Op.Rint  => rint(a)
      case Op.Floor =>
        val x       = a
        val nearest = rint(x)
        blend(nearest, two("sub", nearest, constant(1f)), compare("GT", nearest, x))
      case Op.Ceil =>
        val x       = a
        val nearest = rint(x)
        blend(nearest, two("add", nearest, constant(1f)), compare("LT", nearest, x))
      case Op.Signum =>
        val x    = a
        val zero = constant(0f)
        blend(blend(x, constant(-1f), compare("LT", x, zero)), constant(1f), compare("GT", x, zero))
      case Op.Remainder =>
        val (x, y) = (a, node.args(1))
        val times  =
          if y.isConst then
            two("sub", fma(x, constant((1 / y.value).toFloat), constant(Round)), constant(Round))
          else rint(two("div", x, of(y)))
        if y.isConst then fma(times, constant(-y.value.toFloat), x)
        else fma(unary("neg", times), of(y), x)
      case Op.Always => throw Untraceable("a condition that always holds")

  // Polynomials of Cephes' sinf.c, atanf.c and expf.c; LaneMath has those of the last two for passes written
  // by hand.

  private def sinCos(of: Node): (Int, Int) = pairs.getOrElseUpdate(
    of, {
      val angle    = this.of(of)
      val rounded  = fma(angle, constant(0.63661977f), constant(Round))
      val quarters = two("sub", rounded, constant(Round))
      val rest     = fma(
        quarters,
        constant(-7.549789948768648e-8f),
        fma(quarters, constant(-4.837512969970703e-4f), fma(quarters, constant(-1.5703125f), angle))
      )
      val square = two("mul", rest, rest)
      val sin    = fma(
        two("mul", series(square, -1.9515295891e-4f, 8.3321608736e-3f, -1.6666654611e-1f), square),
        rest,
        rest
      )
      val cos =
        series(square, 2.443315711809948e-5f, -1.388731625493765e-3f, 4.166664568298827e-2f, -0.5f, 1f)
      val quadrant = reinterpret(rounded, "Ints")
      val odd      = toFloatMask(intCompare("LT", shift("LSHL", quadrant, 31), intConstant(0)))
      val sinSign  = shift("LSHL", intTwo("and", quadrant, intConstant(2)), 30)
      val cosSign  =
        shift("LSHL", intTwo("and", intTwo("add", quadrant, intConstant(1)), intConstant(2)), 30)
      (signed(blend(sin, cos, odd), sinSign), signed(blend(cos, sin, odd), cosSign))
    }
  )

  private def atan2(y: Int, x: Int): Int =
    val (ax, ay) = (unary("abs", x), unary("abs", y))
    val steep    = compare("GT", ay, ax)
    val large    = two("add", blend(ax, ay, steep), constant(1e-30f))
    val small    = blend(ay, ax, steep)
    val beyond   = compare("GT", small, two("mul", large, constant(0.41421356f)))
    val ratio    = two(
      "div",
      blend(small, two("sub", small, large), beyond),
      blend(large, two("add", large, small), beyond)
    )
    val square = two("mul", ratio, ratio)
    val rise   = two(
      "mul",
      series(square, 8.05374449538e-2f, -1.38776856032e-1f, 1.99777106478e-1f, -3.33329491539e-1f),
      square
    )
    val first  = fma(rise, ratio, ratio)
    val second = blend(first, two("add", first, constant(0.785398163f)), beyond)
    val third  = blend(second, two("sub", constant(1.57079633f), second), steep)
    val angle  = blend(third, two("sub", constant(3.14159265f), third), compare("LT", x, constant(0f)))
    val sign   = intTwo("and", reinterpret(y, "Ints"), intConstant(Int.MinValue))
    reinterpret(intTwo("or", reinterpret(angle, "Ints"), sign), "Floats")

  private def exp(x: Int): Int =
    val rounded = fma(x, constant(1.44269504f), constant(Round))
    val power   = two("sub", rounded, constant(Round))
    val rest    = fma(power, constant(2.12194440e-4f), fma(power, constant(-0.693359375f), x))
    val tail    = series(
      rest,
      1.9875691500e-4f,
      1.3981999507e-3f,
      8.3334519073e-3f,
      4.1665795894e-2f,
      1.6666665459e-1f,
      5.0000001201e-1f
    )
    val fraction = reinterpret(fma(tail, two("mul", rest, rest), two("add", rest, constant(1f))), "Ints")
    reinterpret(intTwo("add", fraction, shift("LSHL", reinterpret(rounded, "Ints"), 23)), "Floats")

  private def tanh(x: Int): Int =
    val within = limited("GT", limited("LT", x, constant(9f)), constant(-9f))
    val power  = exp(two("add", within, within))
    two("div", two("sub", power, constant(1f)), two("add", power, constant(1f)))

  /** √(1 − |x|) · polynomial: Abramowitz and Stegun, 4.4.46. */
  private def acos(of: Node): Int =
    val x     = this.of(of)
    val plain = isPositive(of)
    val size  = limited("LT", if plain then x else unary("abs", x), constant(1f))
    val rise  = series(
      size,
      -0.0012624911f,
      0.0066700901f,
      -0.0170881256f,
      0.0308918810f,
      -0.0501743046f,
      0.0889789874f,
      -0.2145988016f,
      1.5707963050f
    )
    val angle = two("mul", unary("sqrt", two("sub", constant(1f), size)), rise)
    if plain then angle
    else blend(angle, two("sub", constant(3.14159265f), angle), compare("LT", x, constant(0f)))

  private def isPositive(node: Node): Boolean = node.op match
    case Op.Sqrt | Op.Abs | Op.Exp | Op.Hypot => true
    case Op.Const                             => node.value >= 0
    case Op.Min                               => node.args.forall(isPositive)
    case Op.Max                               => node.args.exists(isPositive)
    case _                                    => false

  private def rint(x: Int): Int = two("sub", two("add", x, constant(Round)), constant(Round))

  /** By Horner's rule, the highest power's coefficient first. */
  private def series(x: Int, coefficients: Float*): Int =
    coefficients.tail.foldLeft(constant(coefficients.head))((sum, each) => fma(sum, x, constant(each)))

  private def signed(x: Int, sign: Int): Int =
    load(reinterpret(x, "Ints"))
    code.getstatic(operators, "XOR", associative)
    load(sign)
    code.invokevirtual(int, "lanewise", MethodTypeDesc.of(int, binary, any))
    reinterpret(stored(), "Floats")

  // Single operations.

  private def constant(value: Float): Int =
    floatConstants.getOrElseUpdate(java.lang.Float.floatToRawIntBits(value), fresh())

  private def intConstant(value: Int): Int = intConstants.getOrElseUpdate(value, fresh())

  private def load(place: Int): Unit = code.aload(place): Unit

  private def stored(): Int =
    val place = fresh()
    code.astore(place)
    place

  private def unary(name: String, a: Int): Int =
    load(a)
    code.invokevirtual(float, name, MethodTypeDesc.of(float))
    stored()

  private def two(name: String, a: Int, b: Int): Int =
    load(a); load(b)
    code.invokevirtual(float, name, MethodTypeDesc.of(float, any))
    stored()

  private def fma(a: Int, b: Int, c: Int): Int =
    load(a); load(b); load(c)
    code.invokevirtual(float, "fma", MethodTypeDesc.of(float, any, any))
    stored()

  private def extreme(how: String, node: Node): Int =
    val Vector(a, b) = node.args
    if b.isConst || b.op == Op.Param then limited(how, of(a), of(b)) else limited(how, of(b), of(a))

  /** The limit where it is less (`LT`) or more (`GT`) than the value: in two instructions, where the vector
    * API's own `min` and `max` take six on most machines. What is no number stays so within limits that are.
    */
  private def limited(how: String, value: Int, limit: Int): Int =
    blend(value, limit, compare(how, limit, value))

  private def blend(otherwise: Int, where: Int, condition: Int): Int =
    load(otherwise); load(where); load(condition)
    code.invokevirtual(float, "blend", MethodTypeDesc.of(float, any, mask))
    stored()

  private def compare(how: String, a: Int, b: Int): Int =
    load(a)
    code.getstatic(operators, how, comparison)
    load(b)
    code.invokevirtual(float, "compare", MethodTypeDesc.of(mask, comparison, any))
    stored()

  private def maskUnary(name: String, a: Int): Int =
    load(a)
    code.invokevirtual(mask, name, MethodTypeDesc.of(mask))
    stored()

  private def maskTwo(name: String, a: Int, b: Int): Int =
    load(a); load(b)
    code.invokevirtual(mask, name, MethodTypeDesc.of(mask, mask))
    stored()

  private def reinterpret(a: Int, as: String): Int =
    val (from, to) = if as == "Ints" then (float, int) else (int, float)
    load(a)
    code.invokevirtual(from, s"reinterpretAs$as", MethodTypeDesc.of(to))
    stored()

  private def intTwo(name: String, a: Int, b: Int): Int =
    load(a); load(b)
    code.invokevirtual(int, name, MethodTypeDesc.of(int, any))
    stored()

  private def shift(how: String, a: Int, by: Int): Int =
    load(a)
    code.getstatic(operators, how, binary).loadConstant(by)
    code.invokevirtual(int, "lanewise", MethodTypeDesc.of(int, binary, ConstantDescs.CD_int))
    stored()

  private def intCompare(how: String, a: Int, b: Int): Int =
    load(a)
    code.getstatic(operators, how, comparison)
    load(b)
    code.invokevirtual(int, "compare", MethodTypeDesc.of(mask, comparison, any))
    stored()

  private def toFloatMask(a: Int): Int =
    load(a)
    code.getstatic(math, "SPECIES", species)
    code.invokevirtual(mask, "cast", MethodTypeDesc.of(mask, species))
    stored()

  /** From an array of the arguments, the worlds' numbers from an index on. */
  private def loaded(argument: Int, from: Int): Int =
    code.getstatic(math, "SPECIES", species).aload(argument).iload(world).loadConstant(from).iadd()
    code.invokestatic(float, "fromArray", MethodTypeDesc.of(float, species, floats, ConstantDescs.CD_int))
    stored()

  /** The same in all worlds. Fetched where it is used: registers are few. */
  private def shared(number: Int): Int =
    code.getstatic(math, "SPECIES", species)
    code.aload(2).loadConstant(number).faload()
    code.invokestatic(float, "broadcast", MethodTypeDesc.of(float, species, ConstantDescs.CD_float))
    stored()

  /** See [[LaneFunction.place]]. */
  private def parameter(number: Int): Int =
    code.getstatic(math, "SPECIES", species).aload(2)
    code.iload(world).loadConstant(parameters).imul().loadConstant(number * LaneMath.LANES).iadd()
    code.invokestatic(float, "fromArray", MethodTypeDesc.of(float, species, floats, ConstantDescs.CD_int))
    stored()

  private def input(number: Int): Int =
    code.getstatic(math, "SPECIES", species)
    locate(number)
    code.invokestatic(float, "fromArray", MethodTypeDesc.of(float, species, floats, ConstantDescs.CD_int))
    stored()

  /** The array of an input or output, and the index of the present worlds in it. */
  private def locate(number: Int): Unit =
    val (of, row)       = places.applyOrElse(number, (own: Int) => (own, 0))
    val (array, offset) = arrays.getOrElseUpdate(of, (fresh(), fresh()))
    code.aload(array).iload(offset).iload(world).iadd()
    if row > 0 then code.loadConstant(row * count).iadd(): Unit

  private def store(vector: Int, argument: Int, to: Int): Unit =
    code.aload(vector).aload(argument).iload(world).loadConstant(to).iadd()
    code.invokevirtual(
      float,
      "intoArray",
      MethodTypeDesc.of(ConstantDescs.CD_void, floats, ConstantDescs.CD_int)
    ): Unit

  private def storeTo(vector: Int, number: Int): Unit =
    code.aload(vector)
    locate(number)
    code.invokevirtual(
      float,
      "intoArray",
      MethodTypeDesc.of(ConstantDescs.CD_void, floats, ConstantDescs.CD_int)
    ): Unit

  private val Round = 12582912f

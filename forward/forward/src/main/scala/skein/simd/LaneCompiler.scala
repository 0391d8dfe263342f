package skein.simd

import java.lang.classfile.{ClassFile, CodeBuilder}
import java.lang.constant.{ClassDesc, ConstantDescs, MethodTypeDesc}
import java.lang.invoke.MethodHandles
import java.lang.reflect.AccessFlag
import scala.collection.mutable
import skein.formula.Node

/** Compiles expressions to a [[LaneFunction]]: passes over blocks of worlds, in which a value stays in a
  * register from its computation to its last use. Elementary functions are the polynomials of [[LaneMath]],
  * written out, so that every lane computes identical bits on every machine; products are fused with sums.
  *
  * A pass calls nothing but the vector API, and is short enough for the JIT compiler to compile in one piece
  * without boxing vectors (see [[LaneMath]]). A longer expression becomes several passes; their intermediate
  * values are stored in scratch memory, which stays in the first-level cache.
  */
object LaneCompiler:

  /** Compiles expressions.
    *
    * @param inputs number of inputs
    * @param outputs expressions to compute
    * @param differences number of the first inputs that are differences of two arrays; the subtrahends'
    *   arrays follow those of the outputs
    * @param parameters number of parameters per world; 0 if all worlds share them
    * @param places index of the array, and row in it, of each input, then of each output; each of those
    *   beyond its end has its own array
    */
  def compile(
      inputs: Int,
      outputs: Vector[Node],
      differences: Int = 0,
      parameters: Int = 0,
      places: Vector[(Int, Int)] = Vector.empty
  ): LaneFunction =
    val bytes  = classFile(inputs, outputs, differences, parameters, places)
    val lookup = MethodHandles.lookup().defineHiddenClass(bytes, true)
    lookup.lookupClass.getDeclaredConstructor().newInstance().asInstanceOf[LaneFunction]

  private[simd] def classFile(
      inputs: Int,
      outputs: Vector[Node],
      differences: Int,
      parameters: Int,
      places: Vector[(Int, Int)]
  ): Array[Byte] =
    val passes  = Passes.of(outputs, ofRows = places.distinctBy(_._1).size < places.size)
    val self    = ClassDesc.of("skein.simd.CompiledLaneFunction")
    val scratch = passes.iterator.flatMap(_.stores).map(_._2 + 1).maxOption.fold(0)(laidBy)
    ClassFile
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
              code => code.loadConstant(scratch).ireturn(): Unit
            )
            .withMethodBody(
              "isOnePass",
              MethodTypeDesc.of(ConstantDescs.CD_boolean),
              ClassFile.ACC_PUBLIC,
              code => code.loadConstant(if passes.size == 1 then 1 else 0).ireturn(): Unit
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

  /** Index in scratch memory of a stored value, by its slot. */
  private[simd] def laidBy(place: Int): Int = LaneFunction.UNUSED + place * LaneFunction.COUNT

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

  val fromArray: MethodTypeDesc = MethodTypeDesc.of(float, species, floats, ConstantDescs.CD_int)
  val intoArray: MethodTypeDesc = MethodTypeDesc.of(ConstantDescs.CD_void, floats, ConstantDescs.CD_int)
  val apply: MethodTypeDesc     =
    MethodTypeDesc.of(ConstantDescs.CD_void, floats.arrayType, ints, floats, floats, ConstantDescs.CD_int)

/** Generates the bytecode of one pass. A vector is identified by its local variable.
  *
  * @param subtrahends index of the first array whose values are subtracted from inputs
  */
private final class PassCompiler(
    code: CodeBuilder,
    pass: Pass,
    inputs: Int,
    differences: Int,
    subtrahends: Int,
    parameters: Int,
    places: Vector[(Int, Int)]
) extends ExpressionCompiler:
  import Names.*
  import LaneCompiler.laidBy
  private val count          = LaneFunction.COUNT
  private val floatConstants = mutable.HashMap.empty[Int, Int]
  private val bitConstants   = mutable.HashMap.empty[Int, Int]
  private val arrays         = mutable.HashMap.empty[Int, (Int, Int)]
  private val end            = 4
  private val world          = 5
  private var next           = 6

  private def fresh(): Int =
    next += 1
    next - 1

  def emit(): Unit =
    // A first, unused generation of the loop finds everything that must precede it.
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
            for value <- first.bitConstants.keys.toVector.sorted do bitConstants(value) = fresh()
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
    for (value, place) <- bitConstants do
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
    for (node, place) <- pass.loads do slots(node) = loaded(3, laidBy(place))
    for node <- pass.computes if !node.op.isLeaf do computed(node): Unit
    for (node, place) <- pass.stores do store(of(node), 3, laidBy(place))
    // All inputs are read before any output is written: see LaneFunction.isOnePass.
    val written = pass.outputs.map((node, output) => (of(node), inputs + output))
    for (vector, number) <- written do storeTo(vector, number)

  // Single operations.

  protected def constant(value: Float): Int =
    floatConstants.getOrElseUpdate(java.lang.Float.floatToRawIntBits(value), fresh())
  protected def bitConstant(value: Int): Int = bitConstants.getOrElseUpdate(value, fresh())

  protected def neg(a: Int): Int                 = call("neg", float, float)(a)
  protected def abs(a: Int): Int                 = call("abs", float, float)(a)
  protected def sqrt(a: Int): Int                = call("sqrt", float, float)(a)
  protected def add(a: Int, b: Int): Int         = call("add", float, float, any)(a, b)
  protected def sub(a: Int, b: Int): Int         = call("sub", float, float, any)(a, b)
  protected def mul(a: Int, b: Int): Int         = call("mul", float, float, any)(a, b)
  protected def div(a: Int, b: Int): Int         = call("div", float, float, any)(a, b)
  protected def fma(a: Int, b: Int, c: Int): Int = call("fma", float, float, any, any)(a, b, c)
  protected def choose(otherwise: Int, where: Int, condition: Int): Int =
    call("blend", float, float, any, mask)(otherwise, where, condition)

  protected def isLess(a: Int, b: Int): Int   = compare(float, "LT", a, b)
  protected def isAtMost(a: Int, b: Int): Int = compare(float, "LE", a, b)
  protected def isEqual(a: Int, b: Int): Int  = compare(float, "EQ", a, b)
  protected def not(a: Int): Int              = call("not", mask, mask)(a)
  protected def and(a: Int, b: Int): Int      = call("and", mask, mask, mask)(a, b)
  protected def or(a: Int, b: Int): Int       = call("or", mask, mask, mask)(a, b)

  protected def bitsOf(a: Int): Int          = call("reinterpretAsInts", float, int)(a)
  protected def ofBits(a: Int): Int          = call("reinterpretAsFloats", int, float)(a)
  protected def addBits(a: Int, b: Int): Int = call("add", int, int, any)(a, b)
  protected def andBits(a: Int, b: Int): Int = call("and", int, int, any)(a, b)
  protected def orBits(a: Int, b: Int): Int  = call("or", int, int, any)(a, b)
  protected def xorBits(a: Int, b: Int): Int =
    code.aload(a)
    code.getstatic(operators, "XOR", associative)
    code.aload(b)
    code.invokevirtual(int, "lanewise", MethodTypeDesc.of(int, binary, any))
    stored()
  protected def shiftLeft(a: Int, by: Int): Int =
    code.aload(a)
    code.getstatic(operators, "LSHL", binary).loadConstant(by)
    code.invokevirtual(int, "lanewise", MethodTypeDesc.of(int, binary, ConstantDescs.CD_int))
    stored()
  protected def isHighest(a: Int): Int =
    code.aload(compare(int, "LT", a, bitConstant(0)))
    code.getstatic(math, "SPECIES", species)
    code.invokevirtual(mask, "cast", MethodTypeDesc.of(mask, species))
    stored()

  /** Calls a method of the first of some vectors; the others are its arguments. */
  private def call(name: String, of: ClassDesc, into: ClassDesc, arguments: ClassDesc*)(vectors: Int*): Int =
    for vector <- vectors do code.aload(vector)
    code.invokevirtual(of, name, MethodTypeDesc.of(into, arguments*))
    stored()

  private def compare(of: ClassDesc, how: String, a: Int, b: Int): Int =
    code.aload(a)
    code.getstatic(operators, how, comparison)
    code.aload(b)
    code.invokevirtual(of, "compare", MethodTypeDesc.of(mask, comparison, any))
    stored()

  private def stored(): Int =
    val place = fresh()
    code.astore(place)
    place

  /** Loads values of the present worlds from an argument's array, from an index on. */
  private def loaded(argument: Int, from: Int): Int =
    code.getstatic(math, "SPECIES", species).aload(argument).iload(world).loadConstant(from).iadd()
    code.invokestatic(float, "fromArray", fromArray)
    stored()

  protected def parameter(number: Int): Int =
    code.getstatic(math, "SPECIES", species).aload(2)
    if parameters == 0 then
      // Equal in all worlds. Loaded at each use, because registers are few.
      code.loadConstant(number).faload()
      code.invokestatic(float, "broadcast", MethodTypeDesc.of(float, species, ConstantDescs.CD_float))
    else
      // See LaneFunction.place.
      code.iload(world).loadConstant(parameters).imul()
      code.loadConstant(LaneFunction.place(number, 0, parameters)).iadd()
      code.invokestatic(float, "fromArray", fromArray)
    stored()

  protected def input(number: Int): Int =
    if number < differences then sub(row(number), row(subtrahends + number)) else row(number)

  private def row(number: Int): Int =
    code.getstatic(math, "SPECIES", species)
    locate(number)
    code.invokestatic(float, "fromArray", fromArray)
    stored()

  /** Pushes the array of an input or output, and the index of the present worlds in it. */
  private def locate(number: Int): Unit =
    val (of, row)       = places.applyOrElse(number, (own: Int) => (own, 0))
    val (array, offset) = arrays.getOrElseUpdate(of, (fresh(), fresh()))
    code.aload(array).iload(offset).iload(world).iadd()
    if row > 0 then code.loadConstant(row * count).iadd(): Unit

  private def store(vector: Int, argument: Int, to: Int): Unit =
    code.aload(vector).aload(argument).iload(world).loadConstant(to).iadd()
    code.invokevirtual(float, "intoArray", intoArray): Unit

  private def storeTo(vector: Int, number: Int): Unit =
    code.aload(vector)
    locate(number)
    code.invokevirtual(float, "intoArray", intoArray): Unit

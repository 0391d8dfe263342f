package skein.formula

import java.lang.classfile.{Opcode, TypeKind}
import java.lang.classfile.instruction.*
import java.lang.constant.{ClassDesc, MethodTypeDesc}
import scala.collection.mutable
import scala.jdk.CollectionConverters.*
import skein.formula.Thing.*
import skein.formula.Value.*

/** Runs a method's bytecode on numbers that are not known yet, and notes what it computes of them in a [[Trace]].
  *
  * Where a condition is not known both ways are gone to where they meet again, and what differs there becomes an
  * [[Op.Where]]. What is known decides at once: loops over it are unrolled, methods called are gone into, objects and
  * arrays made on the way exist here alone. What is not arithmetic is refused ([[Untraceable]]).
  *
  * Objects that were there before are read, never changed. What is read of the object whose method it is becomes a
  * parameter if it is a double, and else something that another object must have alike ([[guards]]) to share the trace.
  */
private[formula] final class Lifter(files: ClassFiles, val trace: Trace):
  import Lifter.*

  private var heap                 = Map.empty[Int, Thing]
  private var made                 = 0
  private var steps                = 0
  private var calls: List[Calling] = Nil
  private val params               = mutable.LinkedHashMap.empty[Path, Node]
  private val alike                = mutable.LinkedHashMap.empty[Guard, Unit]

  /** The ways to the doubles read of the object, in the order of the trace's parameters. */
  def parameters: Vector[Path] = params.keys.toVector

  /** What another object must have alike. */
  def guards: Vector[Guard] = alike.keys.toVector

  def thing(id: Int): Thing = heap(id)

  def make(thing: Thing): Value =
    made += 1
    heap += made -> thing
    Made(made)

  /** What the method answers to these arguments, its object first unless it is static. */
  def call(code: MethodCode, args: Vector[Value]): Value =
    if calls.sizeIs > MostDepth then refuse(s"it calls more than $MostDepth methods within one another")
    val locals = Array.fill[Value](code.slots)(Null)
    args.foldLeft(0): (slot, arg) =>
      locals(slot) = arg
      slot + (if isWide(arg) then 2 else 1)
    val calling = Calling(code)
    calls ::= calling
    val answer = run(Frame(calling, locals, Nil), 0, code.instructions.length) match
      case End.Returned(value) => value
      case End.Reached         => throw IllegalStateException(s"${code.name} ended without returning")
    calls = calls.tail
    answer

  /** Refuses, naming the innermost place that is not a library's. */
  def refuse(reason: String): Nothing =
    val own = calls.find(call => !isLibrary(call.code.owner))
    throw Untraceable(reason, own.fold("")(call => call.code.where(call.at)))

  private def run(frame: Frame, from: Int, stop: Int): End =
    val code = frame.calling.code
    var at   = from
    var end  = Option.empty[End]
    while end.isEmpty do
      if at == stop then end = Some(End.Reached)
      else
        steps += 1
        if steps > MostSteps then
          refuse(s"it has not ended after $MostSteps instructions: a loop without a bound?")
        frame.calling.at = at
        code.instructions(at) match
          case branch: BranchInstruction =>
            val target = code.at(branch.target)
            val taken  = condition(frame, branch.opcode)
            if taken.op == Op.Always then at = target
            else if taken.op == Op.Not && taken.args(0).op == Op.Always then at += 1
            else
              val meet = code.joins(at)
              end = both(frame, taken, target, at, meet)
              at = meet
          case returning: ReturnInstruction =>
            end = Some(End.Returned(if returning.typeKind == TypeKind.VOID then Null else frame.pop()))
          case switch: TableSwitchInstruction =>
            at = code.at(target(frame, switch.defaultTarget, switch.cases.asScala))
          case switch: LookupSwitchInstruction =>
            at = code.at(target(frame, switch.defaultTarget, switch.cases.asScala))
          case _: ThrowInstruction =>
            val what = frame.pop() match
              case Made(id) => heap(id) match
                  case Record(name, _) => name.replace('/', '.')
                  case _               => "an exception"
              case _ => "an exception"
            refuse(s"it throws $what")
          case other =>
            step(frame, other)
            at += 1
    end.get

  /** Goes both ways to where they meet. */
  private def both(frame: Frame, taken: Node, target: Int, at: Int, meet: Int): Option[End] =
    if !frame.calling.open.add(at) then
      refuse("a loop whose end depends on what is observed: give it a fixed number of rounds")
    val before    = heap
    val (yes, no) = (frame.copy, frame.copy)
    val ended     = run(yes, target, meet)
    val after     = heap
    heap = before
    frame.calling.at = at
    val otherwise = run(no, at + 1, meet)
    frame.calling.open -= at
    frame.calling.at = at
    val left   = heap
    val merged = Merge(taken, after, left)
    heap = after ++ left
    (ended, otherwise) match
      case (End.Returned(a), End.Returned(b)) =>
        val value = merged.value(a, b)
        merged.heap()
        Some(End.Returned(value))
      case (End.Reached, End.Reached) =>
        for i <- frame.locals.indices do frame.locals(i) = merged.value(yes.locals(i), no.locals(i))
        frame.stack = yes.stack.zip(no.stack).map(merged.value)
        merged.heap()
        None
      case _ => throw IllegalStateException(s"ways of ${frame.calling.code.name} do not meet")

  /** Makes one of what two ways have left. */
  private final class Merge(condition: Node, yes: Map[Int, Thing], no: Map[Int, Thing]):
    private val pairs = mutable.HashMap.empty[(Int, Int), Value]

    def heap(): Unit =
      for (id, a) <- yes; b <- no.get(id) if a != b do
        Lifter.this.heap += id -> ((a, b) match
          case (Record(name, of), Record(_, or))       => Record(name, fields(of, or))
          case (Elements(of, frozen), Elements(or, _)) => Elements(of.zip(or).map(value), frozen)
          case _                                       => a)

    private def fields(a: Map[String, Value], b: Map[String, Value]): Map[String, Value] =
      (a.keySet ++ b.keySet).iterator
        .map: name =>
          name -> ((a.get(name), b.get(name)) match
            case (Some(one), Some(other)) => value(one, other)
            case (one, other)             => one.orElse(other).get)
        .toMap

    def value(a: Value, b: Value): Value = (a, b) match
      case _ if a == b            => a
      case (Number(x), Number(y)) => Number(trace.where(condition, x, y))
      case (Whole(x), Whole(y))   => Whole(trace.where(condition, x, y))
      case (Boxed(x), Boxed(y))   => Boxed(value(x, y))
      case (Made(x), Made(y))     => pairs.getOrElseUpdate(
          (x, y),
          alikeOf(yes(x), no(y)) match
            case (Record(of, x), Record(or, y)) if of == or       => make(Thing.Either(of, fields(x, y)))
            case (Thing.Either(of, x), Record(or, y)) if of == or => make(Thing.Either(of, fields(x, y)))
            case (Record(of, x), Thing.Either(or, y)) if of == or => make(Thing.Either(of, fields(x, y)))
            case (Thing.Either(of, x), Thing.Either(or, y)) if of == or =>
              make(Thing.Either(of, fields(x, y)))
            case (Elements(x, _), Elements(y, _)) if x.size == y.size =>
              make(Elements(x.zip(y).map(value), isFrozen = true))
            case _ => Undecided
        )
      case _ => Undecided

    /** A tuple of two numbers has a class of its own where one of them is a constant. */
    private def alikeOf(a: Thing, b: Thing): (Thing, Thing) = (classOf(a), classOf(b)) match
      case (Some(x), Some(y)) if x != y => (unspecialised(a), unspecialised(b))
      case _                            => (a, b)

    private def classOf(thing: Thing) = thing match
      case Record(of, _)       => Some(of)
      case Thing.Either(of, _) => Some(of)
      case _                   => None

    private def unspecialised(thing: Thing): Thing = thing match
      case Record(Specialised(of), fields)       => Record(of, boxed(fields))
      case Thing.Either(Specialised(of), fields) => Thing.Either(of, boxed(fields))
      case other                                 => other

    private def boxed(fields: Map[String, Value]) = fields.collect:
      case (SpecialisedField(name), value) => name -> Boxed(value)

  private def step(frame: Frame, instruction: java.lang.classfile.Instruction): Unit = instruction match
    case load: LoadInstruction           => frame.push(frame.locals(load.slot))
    case store: StoreInstruction         => frame.locals(store.slot) = frame.pop()
    case increment: IncrementInstruction =>
      frame.locals(increment.slot) = Whole(wholes(
        Opcode.IADD,
        whole(frame.locals(increment.slot)),
        trace.const(increment.constant)
      ))
    case constant: ConstantInstruction => frame.push(constantOf(constant))
    case stack: StackInstruction       => rearrange(frame, stack.opcode)
    case operator: OperatorInstruction => operate(frame, operator.opcode)
    case convert: ConvertInstruction   => frame.push(converted(frame.pop(), convert.opcode))
    case field: FieldInstruction       => access(frame, field)
    case invoke: InvokeInstruction     =>
      val kind   = invoke.opcode
      val name   = invoke.name.stringValue
      val desc   = invoke.typeSymbol
      val args   = frame.pop(desc.parameterCount + (if kind == Opcode.INVOKESTATIC then 0 else 1))
      val answer = invoked(ClassFiles.internalName(invoke.owner.asSymbol), name, desc, kind, args)
      if desc.returnType.descriptorString != "V" then frame.push(answer)
    case dynamic: InvokeDynamicInstruction => frame.push(closure(frame, dynamic))
    case made: NewObjectInstruction        =>
      frame.push(make(Record(made.className.asInternalName, Map.empty)))
    case made: NewPrimitiveArrayInstruction =>
      val zero = made.typeKind match
        case TypeKind.DOUBLE => Number(trace.const(0))
        case TypeKind.FLOAT  => noFloats()
        case TypeKind.LONG   => Long(0)
        case _               => Whole(trace.const(0))
      frame.push(make(Elements(Vector.fill(length(frame))(zero))))
    case _: NewReferenceArrayInstruction => frame.push(make(Elements(Vector.fill(length(frame))(Null))))
    case _: ArrayLoadInstruction         =>
      val index = known(frame.pop(), "an index")
      frame.push(element(frame.pop(), index))
    case _: ArrayStoreInstruction =>
      val value = frame.pop()
      val index = known(frame.pop(), "an index")
      update(frame.pop(), index, value)
    case check: TypeCheckInstruction =>
      if check.opcode == Opcode.INSTANCEOF then
        frame.push(truth(isA(frame.pop(), check.`type`.asInternalName)))
    case _: NopInstruction => ()
    case other => refuse(s"${other.opcode.name.toLowerCase(java.util.Locale.ROOT)} is not arithmetic")

  private def length(frame: Frame): Int = known(frame.pop(), "an array's length")

  private def constantOf(constant: ConstantInstruction): Value = constant.constantValue match
    case number: java.lang.Double                              => Number(trace.const(number))
    case number: java.lang.Integer                             => Whole(trace.const(number.doubleValue))
    case number: java.lang.Long                                => Long(number)
    case _: java.lang.Float                                    => noFloats()
    case text: String                                          => Known(text, None)
    case none if none eq java.lang.constant.ConstantDescs.NULL => Null
    case other                                                 => Known(other, None)

  private def operate(frame: Frame, opcode: Opcode): Unit = opcode match
    case Opcode.ARRAYLENGTH                       => frame.push(Whole(trace.const(lengthOf(frame.pop()))))
    case Opcode.DNEG                              => frame.push(Number(trace.neg(number(frame.pop()))))
    case Opcode.INEG                              => frame.push(Whole(negated(whole(frame.pop()))))
    case Opcode.LNEG                              => frame.push(Long(-long(frame.pop())))
    case Opcode.LSHL | Opcode.LSHR | Opcode.LUSHR =>
      val by    = known(frame.pop(), "a shift")
      val value = long(frame.pop())
      frame.push(Long(opcode match
        case Opcode.LSHL => value << by
        case Opcode.LSHR => value >> by
        case _           => value >>> by))
    case _ =>
      val b = frame.pop()
      val a = frame.pop()
      frame.push(ofTwo(opcode, a, b))

  private def ofTwo(opcode: Opcode, a: Value, b: Value): Value = opcode match
    case Opcode.DADD                      => Number(trace.add(number(a), number(b)))
    case Opcode.DSUB                      => Number(trace.sub(number(a), number(b)))
    case Opcode.DMUL                      => Number(trace.mul(number(a), number(b)))
    case Opcode.DDIV                      => Number(trace.div(number(a), number(b)))
    case Opcode.DREM                      => refuse("% on doubles; StrictMath.IEEEremainder wraps angles")
    case Opcode.DCMPG                     => Compared(number(a), number(b), 1)
    case Opcode.DCMPL                     => Compared(number(a), number(b), -1)
    case Opcode.LCMP                      => Whole(trace.const(long(a).compare(long(b))))
    case Opcode.LADD                      => Long(long(a) + long(b))
    case Opcode.LSUB                      => Long(long(a) - long(b))
    case Opcode.LMUL                      => Long(long(a) * long(b))
    case Opcode.LDIV                      => Long(long(a) / long(b))
    case Opcode.LREM                      => Long(long(a) % long(b))
    case Opcode.LAND                      => Long(long(a) & long(b))
    case Opcode.LOR                       => Long(long(a) | long(b))
    case Opcode.LXOR                      => Long(long(a) ^ long(b))
    case _ if opcode.name.startsWith("F") => noFloats()
    case _                                => Whole(wholes(opcode, whole(a), whole(b)))

  private def negated(a: Node): Node =
    if a.isConst then trace.const(-a.value.toInt) else trace.sub(trace.const(0), a)

  private def wholes(opcode: Opcode, a: Node, b: Node): Node =
    if a.isConst && b.isConst then
      val (x, y) = (a.value.toInt, b.value.toInt)
      trace.const(opcode match
        case Opcode.IADD               => x + y
        case Opcode.ISUB               => x - y
        case Opcode.IMUL               => x * y
        case Opcode.IDIV if y != 0     => x / y
        case Opcode.IREM if y != 0     => x % y
        case Opcode.IDIV | Opcode.IREM => refuse("it divides by zero")
        case Opcode.IAND               => x & y
        case Opcode.IOR                => x | y
        case Opcode.IXOR               => x ^ y
        case Opcode.ISHL               => x << y
        case Opcode.ISHR               => x >> y
        case Opcode.IUSHR              => x >>> y
        case other => refuse(s"${other.name.toLowerCase(java.util.Locale.ROOT)} is not arithmetic"))
    else
      opcode match
        case Opcode.IADD                  => trace.add(a, b)
        case Opcode.ISUB                  => trace.sub(a, b)
        case Opcode.IMUL                  => trace.mul(a, b)
        case Opcode.IAND if isTruth(a, b) => asNumber(trace.and(holds(a), holds(b)))
        case Opcode.IOR if isTruth(a, b)  => asNumber(trace.or(holds(a), holds(b)))
        case Opcode.IXOR if isTruth(a, b) =>
          trace.where(holds(a), asNumber(trace.not(holds(b))), asNumber(holds(b)))
        case other =>
          refuse(
            s"${other.name.toLowerCase(java.util.Locale.ROOT)} of a whole number that depends on what is observed"
          )

  private def asNumber(condition: Node): Node = trace.where(condition, trace.const(1), trace.const(0))
  private def holds(truth: Node): Node        = trace.not(trace.equal(truth, trace.const(0)))
  private def isTruth(nodes: Node*): Boolean  = nodes.forall: node =>
    node.is(0) || node.is(1) || node.op == Op.Where && isTruth(node.args.drop(1)*)

  private def converted(value: Value, opcode: Opcode): Value = opcode match
    case Opcode.I2D                          => Number(whole(value))
    case Opcode.I2L                          => Long(known(value, "a long"))
    case Opcode.L2I                          => Whole(trace.const(long(value).toInt))
    case Opcode.L2D                          => Number(trace.const(long(value).toDouble))
    case Opcode.D2I if number(value).isConst => Whole(trace.const(number(value).value.toInt))
    case Opcode.D2L if number(value).isConst => Long(number(value).value.toLong)
    case Opcode.D2I | Opcode.D2L             =>
      refuse("it makes a whole number of one that depends on what is observed; math.floor leaves a double")
    case Opcode.I2B => Whole(trace.const(known(value, "a byte").toByte))
    case Opcode.I2S => Whole(trace.const(known(value, "a short").toShort))
    case Opcode.I2C => Whole(trace.const(known(value, "a character").toChar))
    case _          => noFloats()

  private def noFloats(): Nothing = refuse("it computes with floats; formulas are written in doubles")

  /** Whether a branch is taken. */
  private def condition(frame: Frame, opcode: Opcode): Node =
    opcode match
      case Opcode.GOTO | Opcode.GOTO_W         => trace.always
      case Opcode.IFNULL                       => truthOf(decided(frame.pop()) == Null)
      case Opcode.IFNONNULL                    => truthOf(decided(frame.pop()) != Null)
      case Opcode.IF_ACMPEQ | Opcode.IF_ACMPNE =>
        val (b, a) = (decided(frame.pop()), decided(frame.pop()))
        val same   = (a, b) match
          case (Known(x, _), Known(y, _)) => x eq y
          case _                          => a == b
        truthOf(same == (opcode == Opcode.IF_ACMPEQ))
      case Opcode.IFEQ | Opcode.IFNE | Opcode.IFLT | Opcode.IFGE | Opcode.IFGT | Opcode.IFLE =>
        frame.pop() match
          case Compared(a, b, nan) => ofComparison(opcode, a, b, nan)
          case value               => ofWholes(opcode.name.drop(2), whole(value), trace.const(0))
      case _ =>
        val b = whole(frame.pop())
        ofWholes(opcode.name.drop(7), whole(frame.pop()), b)

  private def ofComparison(opcode: Opcode, a: Node, b: Node, ifUnordered: Int): Node =
    val high = ifUnordered > 0
    opcode match
      case Opcode.IFLT => if high then trace.lt(a, b) else trace.not(trace.le(b, a))
      case Opcode.IFLE => if high then trace.le(a, b) else trace.not(trace.lt(b, a))
      case Opcode.IFGT => if high then trace.not(trace.le(a, b)) else trace.lt(b, a)
      case Opcode.IFGE => if high then trace.not(trace.lt(a, b)) else trace.le(b, a)
      case Opcode.IFEQ => trace.equal(a, b)
      case _           => trace.not(trace.equal(a, b))

  private def ofWholes(how: String, a: Node, b: Node): Node = how match
    case "EQ" => trace.equal(a, b)
    case "NE" => trace.not(trace.equal(a, b))
    case "LT" => trace.lt(a, b)
    case "GE" => trace.not(trace.lt(a, b))
    case "GT" => trace.lt(b, a)
    case "LE" => trace.not(trace.lt(b, a))

  private def target(
      frame: Frame,
      default: java.lang.classfile.Label,
      cases: Iterable[SwitchCase]
  ): java.lang.classfile.Label =
    val key = known(frame.pop(), "what a match chooses by")
    cases.find(_.caseValue == key).fold(default)(_.target)

  private def rearrange(frame: Frame, opcode: Opcode): Unit =
    def pop()                   = frame.pop()
    def pushAll(values: Value*) = values.foreach(frame.push)
    def popPair(): List[Value]  =
      val top = pop()
      if isWide(top) then List(top) else List(pop(), top)
    opcode match
      case Opcode.POP     => pop(): Unit
      case Opcode.POP2    => popPair(): Unit
      case Opcode.DUP     => frame.push(frame.stack.head)
      case Opcode.SWAP    => val (a, b) = (pop(), pop()); pushAll(a, b)
      case Opcode.DUP_X1  => val (a, b) = (pop(), pop()); pushAll(a, b, a)
      case Opcode.DUP_X2  => val a = pop(); val below = popPair(); pushAll((a :: below) :+ a*)
      case Opcode.DUP2    => val top = popPair(); pushAll(top ++ top*)
      case Opcode.DUP2_X1 => val top = popPair(); val below = pop(); pushAll(top ++ (below :: top)*)
      case _              => val top = popPair(); val below = popPair(); pushAll(top ++ below ++ top*)

  // Objects.

  private def access(frame: Frame, field: FieldInstruction): Unit =
    val owner = ClassFiles.internalName(field.owner.asSymbol)
    val name  = field.name.stringValue
    field.opcode match
      case Opcode.GETSTATIC => frame.push(static(owner, name))
      case Opcode.PUTSTATIC => refuse(s"it changes $name, which everybody shares")
      case Opcode.GETFIELD  => frame.push(fieldOf(frame.pop(), name, field.typeSymbol))
      case _                =>
        val value = frame.pop()
        frame.pop() match
          case Made(id) => heap(id) match
              case Record(className, fields) => heap += id -> Record(className, fields + (name -> value))
              case _ => refuse("it changes one of two objects, as a condition decides")
          case _ => refuse(s"it changes $name of an object that was there before; a formula changes nothing")

  private def static(owner: String, name: String): Value =
    val field = found(files.load(owner), name)
    if !java.lang.reflect.Modifier.isFinal(field.getModifiers) && !isLibrary(owner) then
      refuse(s"it reads the variable $name, which everybody shares")
    held(open(field).get(null), None, field.getType)

  private def fieldOf(of: Value, name: String, kind: ClassDesc): Value = decided(of) match
    case Made(id) => heap(id) match
        case Record(_, fields)       => fields.getOrElse(name, zeroOf(kind))
        case Thing.Either(_, fields) => fields.getOrElse(name, zeroOf(kind))
        case _                       => refuse(s"it reads $name of an array or a closure")
    case Known(what, path) =>
      val field = found(what.getClass, name)
      if !java.lang.reflect.Modifier.isFinal(field.getModifiers) && !isLibrary(internal(what.getClass)) then
        refuse(s"it reads the variable $name; a formula's object has values alone")
      val value = open(field).get(what)
      held(value, path.map(way => Path(Some(way), Step.Of(field))), field.getType)
    case Null => refuse(s"it reads $name of nothing")
    case _    => refuse(s"it reads $name of a number")

  private def zeroOf(kind: ClassDesc): Value = kind.descriptorString match
    case "D"                      => Number(trace.const(0))
    case "J"                      => Long(0)
    case "F"                      => noFloats()
    case text if text.length == 1 => Whole(trace.const(0))
    case _                        => Null

  private def found(in: Class[?], name: String): java.lang.reflect.Field =
    Iterator
      .iterate[Class[?]](in)(_.getSuperclass)
      .takeWhile(_ != null)
      .flatMap(each => each.getDeclaredFields.find(_.getName == name))
      .nextOption()
      .getOrElse(refuse(s"${in.getName} has no field $name"))

  private def open(field: java.lang.reflect.Field): java.lang.reflect.Field =
    if field.trySetAccessible() then field
    else refuse(s"it uses ${field.getDeclaringClass.getName}, which is not arithmetic")

  /** What an object that was there before holds. */
  private def held(value: AnyRef, path: Option[Path], kind: Class[?]): Value =
    def alikeIn(expected: Any): Unit = path.foreach(way => alike(Guard(way, expected)) = ())
    value match
      case null                     => alikeIn(null); Null
      case number: java.lang.Double =>
        val node =
          path.fold(trace.const(number))(way => params.getOrElseUpdate(way, trace.param(params.size)))
        if kind == classOf[Double] then Number(node)
        else
          alikeIn(number.getClass)
          Boxed(Number(node))
      case _: java.lang.Float     => noFloats()
      case number: java.lang.Long =>
        alikeIn(number)
        if kind == classOf[scala.Long] then Long(number) else Boxed(Long(number))
      case simple: (java.lang.Integer | java.lang.Short | java.lang.Byte | java.lang.Boolean |
            java.lang.Character) =>
        alikeIn(simple)
        val node = Whole(trace.const(wholeOf(simple)))
        if kind.isPrimitive then node else Boxed(node)
      case text: String => alikeIn(text); Known(text, None)
      case other        => alikeIn(other.getClass); Known(other, path)

  private def element(array: Value, index: Int): Value = decided(array) match
    case Made(id) => heap(id) match
        case Elements(values, _) if values.indices.contains(index) => values(index)
        case Elements(values, _) => refuse(s"index $index of an array of ${values.size}")
        case _                   => refuse("an element of what is no array")
    case Known(what, path) if what.getClass.isArray =>
      val size = java.lang.reflect.Array.getLength(what)
      if index < 0 || index >= size then refuse(s"index $index of an array of $size")
      val way = path.map(before => Path(Some(before), Step.At(index)))
      held(java.lang.reflect.Array.get(what, index), way, what.getClass.getComponentType)
    case _ => refuse("an element of what is no array")

  private def update(array: Value, index: Int, value: Value): Unit = decided(array) match
    case Made(id) => heap(id) match
        case Elements(values, false) if values.indices.contains(index) =>
          val fitting = (values(index), value) match
            case (_: (Number | Whole | Long), Boxed(inner)) => inner
            case _                                          => value
          heap += id -> Elements(values.updated(index, fitting))
        case Elements(values, false) => refuse(s"index $index of an array of ${values.size}")
        case _                       => refuse("it changes one of two arrays, as a condition decides")
    case _ => refuse("it changes an array that was there before; a formula changes nothing")

  private def inObject(value: Value): Value = value match
    case _: (Number | Whole | Long) => Boxed(value)
    case _                          => value

  private def lengthOf(array: Value): Int = decided(array) match
    case Made(id) => heap(id) match
        case Elements(values, _) => values.size
        case _                   => refuse("the length of what is no array")
    case Known(what, path) if what.getClass.isArray =>
      val size = java.lang.reflect.Array.getLength(what)
      path.foreach(way => alike(Guard(way, Guard.Length(size))) = ())
      size
    case _ => refuse("the length of what is no array")

  private def classOfThing(value: Value): Option[String] = value match
    case Made(id) => heap(id) match
        case Record(name, _)             => Some(name)
        case Thing.Either(name, _)       => Some(name)
        case Closure(interface, _, _, _) => Some(interface)
        case _                           => None
    case Known(what, _)   => Some(internal(what.getClass))
    case Boxed(Number(_)) => Some("java/lang/Double")
    case Boxed(Whole(_))  => Some("java/lang/Integer")
    case _                => None

  private def isA(value: Value, name: String): Boolean = decided(value) match
    case Null                                        => false
    case Made(id) if heap(id).isInstanceOf[Elements] =>
      heap(id).asInstanceOf[Elements].values.headOption match
        case Some(_: Number) => name == "[D"
        case Some(_: Whole)  => name == "[I"
        case _               => name == "[Ljava/lang/Object;"
    case Known(what, _) => files.load(name.replace('/', '.')).isInstance(what)
    case other          =>
      classOfThing(other).exists(own => files.load(name).isAssignableFrom(files.load(own)))

  // Calls.

  private def invoked(
      owner: String,
      name: String,
      desc: MethodTypeDesc,
      kind: Opcode,
      args: Vector[Value]
  ): Value =
    intrinsic(owner, name, desc.descriptorString, args).getOrElse:
      val dispatches = kind == Opcode.INVOKEVIRTUAL || kind == Opcode.INVOKEINTERFACE
      val receiver   = if kind == Opcode.INVOKESTATIC then None else Some(decided(args.head))
      if receiver.contains(Null) then refuse(s"it calls $name of nothing")
      receiver match
        case Some(Made(id)) if dispatches && heap(id).isInstanceOf[Closure] =>
          val closure = heap(id).asInstanceOf[Closure]
          if closure.method == name then
            applied(closure, args.tail, desc.returnType)
          else into(closure.interface, name, desc, args)
        case Some(value) if dispatches => into(classOfThing(value).getOrElse(owner), name, desc, args)
        case _                         => into(owner, name, desc, args)

  private def hasBody(owner: String, name: String, desc: MethodTypeDesc) =
    files.method(owner, name, desc.descriptorString).isDefined

  private def into(owner: String, name: String, desc: MethodTypeDesc, args: Vector[Value]): Value =
    val where = owner.replace('/', '.')
    if (owner.startsWith("java/") || owner.startsWith("jdk/")) && !Arithmetical(owner) then
      refuse(s"it calls $where.$name, which is not arithmetic")
    files.method(owner, name, desc.descriptorString) match
      case Some(code)                              => call(code, args)
      case None if files.classModel(owner).isEmpty =>
        refuse(s"it calls $name of $where, which has no class file: a lambda expression? A class has one")
      case None => refuse(s"it calls $where.$name, which has no bytecode")

  private def closure(frame: Frame, dynamic: InvokeDynamicInstruction): Value =
    val captured = frame.pop(dynamic.typeSymbol.parameterCount)
    if dynamic.bootstrapMethod.owner.descriptorString != "Ljava/lang/invoke/LambdaMetafactory;" then
      Known("a text", None)
    else
      dynamic.bootstrapArgs.get(1) match
        case handle: java.lang.constant.DirectMethodHandleDesc =>
          import java.lang.constant.DirectMethodHandleDesc.Kind as Handle
          val kind = handle.kind match
            case Handle.STATIC | Handle.INTERFACE_STATIC => Thing.Kind.Static
            case Handle.CONSTRUCTOR                      => Thing.Kind.Constructor
            case _                                       => Thing.Kind.Instance
          val impl = Impl(
            ClassFiles.internalName(handle.owner),
            handle.methodName,
            handle.lookupDescriptor,
            kind
          )
          val interface = ClassFiles.internalName(dynamic.typeSymbol.returnType)
          make(Closure(interface, dynamic.name.stringValue, impl, captured))
        case _ => refuse("a closure of an unknown kind")

  private def applied(closure: Closure, args: Vector[Value], answers: ClassDesc): Value =
    val impl          = closure.impl
    val desc          = MethodTypeDesc.ofDescriptor(impl.descriptor)
    val all           = closure.captured ++ args
    val (first, rest) = if impl.kind == Thing.Kind.Instance then all.splitAt(1) else (Vector.empty, all)
    val fitting       = rest.zip(desc.parameterList.asScala).map(fit)
    val answer        = impl.kind match
      case Thing.Kind.Static   => into(impl.owner, impl.name, desc, fitting)
      case Thing.Kind.Instance =>
        val owner = classOfThing(decided(first.head)).getOrElse(impl.owner)
        into(
          if hasBody(impl.owner, impl.name, desc) then impl.owner else owner,
          impl.name,
          desc,
          first ++ fitting
        )
      case Thing.Kind.Constructor =>
        val made = make(Record(impl.owner, Map.empty))
        into(impl.owner, "<init>", desc, made +: fitting): Unit
        made
    fit(answer, answers)

  private def fit(value: Value, to: ClassDesc): Value = value match
    case Boxed(inner) if to.isPrimitive                => inner
    case _: (Number | Whole | Long) if !to.isPrimitive => Boxed(value)
    case _                                             => value

  private def intrinsic(owner: String, name: String, desc: String, args: Vector[Value]): Option[Value] =
    (owner, name) match
      case ("java/lang/Math" | "java/lang/StrictMath", _) => function(owner, name, desc, args)
      // It is thrown, and refused then.
      case (thrown, "<init>") if classOf[Throwable].isAssignableFrom(files.load(thrown)) => Some(Null)
      case ("java/lang/Object", "<init>")                                                => Some(Null)
      case ("java/lang/System", "arraycopy")                                             => copied(args)
      case ("scala/reflect/ClassTag$", "apply")                                          => args(1) match
          case Known(of: Class[?], _) => Some(Known(scala.reflect.ClassTag(of), None))
          case _                      => None
      case ("scala/runtime/ScalaRunTime$", "array_length") => Some(Whole(trace.const(lengthOf(args(1)))))
      case ("scala/runtime/ScalaRunTime$", "array_apply")  =>
        Some(inObject(element(args(1), known(args(2), "an index"))))
      case ("scala/runtime/ScalaRunTime$", "array_update") =>
        update(args(1), known(args(2), "an index"), args(3))
        Some(Null)
      case (array, "clone") if array.startsWith("[") =>
        Some(make(Elements(Vector.tabulate(lengthOf(args(0)))(element(args(0), _)))))
      case ("java/lang/Integer" | "java/lang/Long", _) if desc.forall("IJ()".contains(_)) =>
        Some(ofKnown(owner, name, desc, args))
      case ("java/lang/Double", "isNaN") =>
        val x = number(if desc == "(D)Z" then args(0) else unboxed(args(0)))
        Some(Whole(asNumber(trace.not(trace.equal(x, x)))))
      case ("java/lang/Double" | "java/lang/Integer" | "java/lang/Boolean" | "java/lang/Long", "valueOf")
          if desc.length > 3 && desc(2) == ')' =>
        Some(Boxed(args(0)))
      case ("java/lang/Double", "doubleValue") | ("java/lang/Integer", "intValue") |
          ("java/lang/Boolean", "booleanValue") =>
        Some(unboxed(args(0)))
      case ("scala/runtime/BoxesRunTime", "boxToDouble" | "boxToInteger" | "boxToBoolean" | "boxToLong") =>
        Some(Boxed(args(0)))
      case (
            "scala/runtime/BoxesRunTime",
            "unboxToDouble" | "unboxToInt" | "unboxToBoolean" | "unboxToLong"
          ) =>
        Some(unboxed(args.last))
      case _ => None

  /** A static method of whole numbers that are known. */
  private def ofKnown(owner: String, name: String, desc: String, args: Vector[Value]): Value =
    val numbers = args.map:
      case Long(number) => java.lang.Long.valueOf(number)
      case value        => java.lang.Integer.valueOf(known(value, s"what $name is asked"))
    val types  = java.lang.invoke.MethodType.fromMethodDescriptorString(desc, null)
    val method = Class.forName(owner.replace('/', '.')).getMethod(name, types.parameterArray*)
    method.invoke(null, numbers*) match
      case number: java.lang.Long => Long(number)
      case number                 => Whole(trace.const(wholeOf(number)))

  private def copied(args: Vector[Value]): Option[Value] =
    val Vector(fromAt, toAt, count) = Vector(1, 3, 4).map(i => known(args(i), "an index"))
    decided(args(2)) match
      case Made(id) => heap(id) match
          case Elements(values, false) =>
            val copy = Vector.tabulate(count)(i => element(args(0), fromAt + i))
            heap += id -> Elements(values.patch(toAt, copy, count))
            Some(Null)
          case _ => refuse("it changes one of two arrays, as a condition decides")
      case _ => refuse("it changes an array that was there before; a formula changes nothing")

  private def unboxed(value: Value): Value = decided(value) match
    case Boxed(inner) => inner
    case _            => refuse("a number was expected in an object")

  private def function(owner: String, name: String, desc: String, args: Vector[Value]): Option[Value] =
    val exact          = owner.endsWith("StrictMath")
    def strict(): Unit =
      if !exact then
        refuse(s"Math.$name, whose last bit is the processor's own; StrictMath.$name is the same everywhere")
    (desc, Unary.get(name), Binary.get(name)) match
      case ("(D)D", Some(op), _) =>
        if !Exact(op) then strict()
        Some(Number(trace.unary(op, number(args(0)))))
      case ("(DD)D", _, Some(op)) =>
        if !Exact(op) then strict()
        Some(Number(trace.binary(op, number(args(0)), number(args(1)))))
      case _ if Composed(name)      => None
      case ("(II)I" | "(I)I", _, _) => None
      case _                        => refuse(
          s"$name is not among the functions of formulas (${(Unary.keys ++ Binary.keys).toSeq.sorted.mkString(", ")})"
        )

  // Values.

  private def number(value: Value): Node = decided(value) match
    case Number(node) => node
    case other        => throw IllegalStateException(s"a number was expected, came $other")

  private def whole(value: Value): Node = decided(value) match
    case Whole(node) => node
    case _: Compared => refuse("it keeps the order of two numbers instead of asking for it")
    case other       => throw IllegalStateException(s"a whole number was expected, came $other")

  private def long(value: Value): scala.Long = decided(value) match
    case Long(number) => number
    case other        => throw IllegalStateException(s"a long was expected, came $other")

  private def known(value: Value, what: String): Int =
    val node = whole(value)
    if node.isConst then node.value.toInt else refuse(s"$what that depends on what is observed")

  private def decided(value: Value): Value =
    if value == Undecided then refuse("which of two objects it is depends on what is observed") else value

  private def truth(holds: Boolean): Value  = Whole(trace.const(if holds then 1 else 0))
  private def truthOf(holds: Boolean): Node = if holds then trace.always else trace.never

private[formula] object Lifter:
  private val MostSteps = 5_000_000
  private val MostDepth = 200

  /** Scala's classes of tuples of primitive numbers, and their fields. */
  private val Specialised      = """(scala/Tuple[12])\$mc[A-Z]+\$sp""".r
  private val SpecialisedField = """(\w+)\$mc[A-Z]\$sp""".r

  private enum End:
    case Reached
    case Returned(value: Value)

  private final class Calling(val code: MethodCode):
    var at                     = 0
    val open: mutable.Set[Int] = mutable.HashSet.empty

  private final class Frame(val calling: Calling, val locals: Array[Value], var stack: List[Value]):
    def copy: Frame              = Frame(calling, locals.clone, stack)
    def push(value: Value): Unit = stack ::= value
    def pop(): Value             =
      val top = stack.head
      stack = stack.tail
      top
    def pop(count: Int): Vector[Value] = Vector.fill(count)(pop()).reverse

  private def isWide(value: Value) = value.isInstanceOf[Number] || value.isInstanceOf[Long]

  private def isLibrary(owner: String) =
    owner.startsWith("scala/") || owner.startsWith("java/") || owner.startsWith("jdk/")

  private def internal(of: Class[?]) = of.getName.replace('.', '/')

  /** Classes of the JDK whose methods may be gone into. */
  private val Arithmetical = Set("java/lang/Math", "java/lang/StrictMath", "java/lang/Object")

  private val Unary = Map(
    "sqrt"   -> Op.Sqrt,
    "abs"    -> Op.Abs,
    "sin"    -> Op.Sin,
    "cos"    -> Op.Cos,
    "asin"   -> Op.Asin,
    "acos"   -> Op.Acos,
    "atan"   -> Op.Atan,
    "exp"    -> Op.Exp,
    "tanh"   -> Op.Tanh,
    "floor"  -> Op.Floor,
    "ceil"   -> Op.Ceil,
    "rint"   -> Op.Rint,
    "signum" -> Op.Signum
  )

  private val Binary = Map(
    "min"           -> Op.Min,
    "max"           -> Op.Max,
    "atan2"         -> Op.Atan2,
    "hypot"         -> Op.Hypot,
    "IEEEremainder" -> Op.Remainder
  )

  /** Those that are exact, so that Math and StrictMath are one. */
  private val Exact =
    Set(Op.Sqrt, Op.Abs, Op.Floor, Op.Ceil, Op.Rint, Op.Signum, Op.Min, Op.Max, Op.Remainder)

  /** Made of others in the JDK's own code. */
  private val Composed = Set("toRadians", "toDegrees", "clamp")

  private def wholeOf(simple: AnyRef): Int = simple match
    case number: java.lang.Number       => number.intValue
    case truth: java.lang.Boolean       => if truth then 1 else 0
    case character: java.lang.Character => character.charValue.toInt
    case other                          => throw IllegalArgumentException(other.toString)

/** What an object must have at the end of a way: a class, a number, nothing, or a [[Guard.Length]]. */
private[formula] final case class Guard(path: Path, expected: Any)

private[formula] object Guard:
  /** Of an array. */
  final case class Length(value: Int)

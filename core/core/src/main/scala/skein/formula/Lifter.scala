package skein.formula

import java.lang.classfile.{Opcode, TypeKind}
import java.lang.classfile.instruction.*
import java.lang.constant.MethodTypeDesc
import scala.collection.mutable
import scala.jdk.CollectionConverters.*
import skein.formula.Thing.*
import skein.formula.Value.*

/** Executes a method's bytecode symbolically, and records its computations on the inputs in a [[Trace]].
  *
  * If a condition is unknown, both branches are executed up to the point where they meet; values that differ
  * there become an [[Op.Where]]. Known values are computed immediately: loops over them are unrolled, and
  * calls are traced into. Objects and arrays that the method creates exist only during tracing ([[Objects]]).
  * Everything that is not arithmetic is refused ([[Untraceable]]).
  */
private[formula] final class Lifter(files: ClassFiles, val trace: Trace):
  import Lifter.*

  private val assumptions          = Assumptions()
  private val numbers: Arithmetic  = Arithmetic(trace, assumptions, refuse)
  private val objects: Objects     = Objects(files, trace, numbers, refuse)
  private val invocations: Calls   = Calls(files, trace, numbers, objects, call, bothCalls, refuse)
  private var steps                = 0
  private var calls: List[Calling] = Nil

  // Source line of the last call's result, until the method itself has returned.
  private var answeredAt = ""
  private var isDone     = false
  import numbers.*
  export objects.{argument, element, fieldOf, guards, lengthOf, make, parameters, thing}
  export numbers.settled

  /** The method's result for these arguments. Unless the method is static, the receiver is the first
    * argument.
    */
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
    isDone |= calls.isEmpty
    answer

  /** Calls a method without arguments on an object. */
  def get(of: Value, name: String, answers: String): Value =
    invocations.invoked(
      "java/lang/Object",
      name,
      MethodTypeDesc.ofDescriptor(s"()$answers"),
      Opcode.INVOKEVIRTUAL,
      Vector(of)
    )

  def classOf(value: Value): Option[String] = objects.classOfThing(value)

  def numberOf(value: Value): Node = flat(value) match
    case node: Number => node.node
    case _            => refuse("it answers with something else than a number")

  /** The node of an integer or a boolean, boxed or not. */
  def wholeOf(value: Value): Node = flat(value) match
    case Whole(node) => node
    case _           => refuse("it answers with something else than a whole number")

  private def flat(value: Value): Value = settled(value) match
    case Boxed(inner)              => flat(inner)
    case OneOf(condition, yes, no) => either(condition, flat(yes), flat(no))
    case one                       => one

  def isKnown(value: Value, what: AnyRef): Boolean = flat(value) match
    case Known(other, _) => other == what
    case Whole(node)     => node.isConst && what != null && node.value == Value.wholeOf(what)
    case Long(number)    => what == java.lang.Long.valueOf(number)
    case _               => false

  /** Throws [[Untraceable]] with the innermost source line outside libraries. Once the lifted method has
    * returned, that is the line at which the last user method that it called returned.
    */
  def refuse(reason: String): Nothing =
    val own = calls.find(call => !ClassFiles.isLibrary(call.code.owner))
    throw Untraceable(reason, own.fold(answeredAt)(call => call.code.where(call.at)))

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
            if !isDone && calls.sizeIs > 1 && !ClassFiles.isLibrary(code.owner) then
              answeredAt = code.where(at)
            end = Some(End.Returned(if returning.typeKind == TypeKind.VOID then Null else frame.pop()))
          case switch: TableSwitchInstruction =>
            at = code.at(target(frame, switch.defaultTarget, switch.cases.asScala))
          case switch: LookupSwitchInstruction =>
            at = code.at(target(frame, switch.defaultTarget, switch.cases.asScala))
          case _: ThrowInstruction =>
            val what = frame.pop() match
              case Made(id) => thing(id) match
                  case Record(name, _) => name.replace('/', '.')
                  case _               => "an exception"
              case _ => "an exception"
            refuse(s"it throws $what")
          case other =>
            step(frame, other)
            at += 1
    end.get

  /** Executes both branches of a condition up to the point where they meet. */
  private def both(frame: Frame, taken: Node, target: Int, at: Int, meet: Int): Option[End] =
    val rounds = frame.calling.open.getOrElse(at, 0)
    if rounds == MostRounds then
      refuse(
        s"a loop whose end depends on what is observed, after $MostRounds rounds: give it a fixed number of rounds"
      )
    frame.calling.open(at) = rounds + 1
    val before    = objects.now
    val (yes, no) = (frame.copy, frame.copy)
    val ended     = assumptions.under(taken, holds = true)(run(yes, target, meet))
    val after     = objects.now
    objects.backTo(before)
    frame.calling.at = at
    val otherwise = assumptions.under(taken, holds = false)(run(no, at + 1, meet))
    frame.calling.open(at) = rounds
    frame.calling.at = at
    val merged = objects.Merge(taken, before, after)
    (ended, otherwise) match
      case (End.Returned(a), End.Returned(b)) =>
        val value = merged.value(a, b)
        merged.things()
        Some(End.Returned(value))
      case (End.Reached, End.Reached) =>
        for i <- frame.locals.indices do frame.locals(i) = merged.value(yes.locals(i), no.locals(i))
        frame.stack = yes.stack.zip(no.stack).map(merged.value)
        merged.things()
        None
      case _ => throw IllegalStateException(s"ways of ${frame.calling.code.name} do not meet")

  /** Executes two calls, and joins their results by a condition. */
  private def bothCalls(condition: Node, yes: => Value, no: => Value): Value =
    val before = objects.now
    val ofYes  = assumptions.under(condition, holds = true)(yes)
    val after  = objects.now
    objects.backTo(before)
    val ofNo   = assumptions.under(condition, holds = false)(no)
    val merged = objects.Merge(condition, before, after)
    val answer = merged.value(ofYes, ofNo)
    merged.things()
    answer

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
      val answer = invocations.invoked(ClassFiles.internalName(invoke.owner.asSymbol), name, desc, kind, args)
      if desc.returnType.descriptorString != "V" then frame.push(answer)
    case dynamic: InvokeDynamicInstruction =>
      frame.push(invocations.closure(dynamic, frame.pop(dynamic.typeSymbol.parameterCount)))
    case made: NewObjectInstruction =>
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
      val index = whole(frame.pop())
      frame.push(objects.elementAt(frame.pop(), index))
    case _: ArrayStoreInstruction =>
      val value = frame.pop()
      val index = known(frame.pop(), "an index")
      objects.update(frame.pop(), index, value)
    case check: TypeCheckInstruction =>
      if check.opcode == Opcode.INSTANCEOF then
        val kind = check.`type`.asInternalName
        frame.push(Whole(asNumber(asked(frame.pop())(each => truthOf(objects.isA(each, kind))))))
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
    case Opcode.ARRAYLENGTH => frame.push(Whole(trace.const(objects.lengthOf(frame.pop()))))
    case Opcode.DNEG        => frame.push(Number(trace.neg(number(frame.pop()))))
    case Opcode.INEG        => frame.push(Whole(negated(whole(frame.pop()))))
    case Opcode.LNEG        => frame.push(opposite(frame.pop()))
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

  private def condition(frame: Frame, opcode: Opcode): Node =
    opcode match
      case Opcode.GOTO | Opcode.GOTO_W         => trace.always
      case Opcode.IFNULL                       => asked(frame.pop())(each => truthOf(each == Null))
      case Opcode.IFNONNULL                    => asked(frame.pop())(each => truthOf(each != Null))
      case Opcode.IF_ACMPEQ | Opcode.IF_ACMPNE =>
        val (b, a) = (frame.pop(), frame.pop())
        asked(a): one =>
          asked(b): other =>
            val same = (one, other) match
              case (Known(x, _), Known(y, _)) => x eq y
              case _                          => one == other
            truthOf(same == (opcode == Opcode.IF_ACMPEQ))
      case Opcode.IFEQ | Opcode.IFNE | Opcode.IFLT | Opcode.IFGE | Opcode.IFGT | Opcode.IFLE =>
        frame.pop() match
          case Compared(a, b, nan) => ofComparison(opcode, a, b, nan)
          case value               => ofWholes(opcode.name.drop(2), whole(value), trace.const(0))
      case _ =>
        val b = whole(frame.pop())
        ofWholes(opcode.name.drop(7), whole(frame.pop()), b)

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

  private def access(frame: Frame, field: FieldInstruction): Unit =
    val owner = ClassFiles.internalName(field.owner.asSymbol)
    val name  = field.name.stringValue
    field.opcode match
      case Opcode.GETSTATIC => frame.push(objects.static(owner, name))
      case Opcode.PUTSTATIC => refuse(s"it changes $name, which everybody shares")
      case Opcode.GETFIELD  => frame.push(objects.fieldOf(frame.pop(), name, field.typeSymbol))
      case _                =>
        val value = frame.pop()
        objects.put(frame.pop(), name, value)

private[formula] object Lifter:
  private val MostSteps = 5_000_000
  private val MostDepth = 200

  /** Maximum number of rounds of a loop that may end earlier, depending on the inputs. */
  private val MostRounds = 64

  private enum End:
    case Reached
    case Returned(value: Value)

  private final class Calling(val code: MethodCode):
    var at = 0

    /** By branch, the number of its conditions that are being executed: in a loop, one per round. */
    val open: mutable.HashMap[Int, Int] = mutable.HashMap.empty

  private final class Frame(val calling: Calling, val locals: Array[Value], var stack: List[Value]):
    def copy: Frame              = Frame(calling, locals.clone, stack)
    def push(value: Value): Unit = stack ::= value
    def pop(): Value             =
      val top = stack.head
      stack = stack.tail
      top
    def pop(count: Int): Vector[Value] = Vector.fill(count)(pop()).reverse

  private def isWide(value: Value): Boolean = value match
    case _: (Number | Long | Time) => true
    case OneOf(_, one, _)          => isWide(one)
    case Unreadable(_, isWide)     => isWide
    case _                         => false

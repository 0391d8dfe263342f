package skein.formula

import java.lang.classfile.{Opcode, TypeKind}
import java.lang.classfile.instruction.*
import scala.collection.mutable
import scala.jdk.CollectionConverters.*
import skein.formula.Thing.*
import skein.formula.Value.*

/** Runs a method's bytecode on numbers that are not known yet, and notes what it computes of them in a
  * [[Trace]].
  *
  * Where a condition is not known both ways are gone to where they meet again, and what differs there becomes
  * an [[Op.Where]]. What is known decides at once: loops over it are unrolled, methods called are gone into,
  * objects and arrays made on the way exist here alone ([[Objects]]). What is not arithmetic is refused
  * ([[Untraceable]]).
  */
private[formula] final class Lifter(files: ClassFiles, val trace: Trace):
  import Lifter.*

  private val numbers: Arithmetic  = Arithmetic(trace, refuse)
  private val objects: Objects     = Objects(files, trace, numbers, refuse)
  private val invocations: Calls   = Calls(files, trace, numbers, objects, call, refuse)
  private var steps                = 0
  private var calls: List[Calling] = Nil
  import numbers.*
  export objects.{guards, make, parameters, thing}

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
    val own = calls.find(call => !ClassFiles.isLibrary(call.code.owner))
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
              case Made(id) => thing(id) match
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
    val before    = objects.now
    val (yes, no) = (frame.copy, frame.copy)
    val ended     = run(yes, target, meet)
    val after     = objects.now
    objects.backTo(before)
    frame.calling.at = at
    val otherwise = run(no, at + 1, meet)
    frame.calling.open -= at
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
      val index = known(frame.pop(), "an index")
      frame.push(objects.element(frame.pop(), index))
    case _: ArrayStoreInstruction =>
      val value = frame.pop()
      val index = known(frame.pop(), "an index")
      objects.update(frame.pop(), index, value)
    case check: TypeCheckInstruction =>
      if check.opcode == Opcode.INSTANCEOF then
        frame.push(truth(objects.isA(frame.pop(), check.`type`.asInternalName)))
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
    case Opcode.LNEG        => frame.push(Long(-long(frame.pop())))
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

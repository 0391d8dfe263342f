package skein.simd

import java.util.{Collections, WeakHashMap}
import java.util.concurrent.CopyOnWriteArrayList
import skein.formula.Untraceable

/** A cache of the compiled forms of one kind of object, shared by all threads.
  *
  * @param fits whether an object has a form
  * @param mostRefused number of refusals after which, without any success, further objects are refused
  *   without an attempt, because compiling takes milliseconds
  * @param compile compiles an object's form, or states why it has none
  */
private[skein] final class Forms[Of, Form](fits: (Form, Of) => Boolean, mostRefused: Int = Int.MaxValue)(
    compile: Of => Either[Untraceable, Form]
):
  private val known = CopyOnWriteArrayList[Form]()

  /** Objects that were refused. Others of their class may still be formulas. */
  private val refused  = Collections.synchronizedMap(WeakHashMap[Of, Untraceable]())
  private var refusals = 0
  private var last     = Option.empty[Untraceable]

  def apply(of: Of): Either[Untraceable, Form] =
    find(of).getOrElse(known.synchronized(find(of).orElse(refusedUnseen).getOrElse {
      val made =
        try compile(of)
        catch case why: Untraceable => Left(why)
      made match
        case Right(form) => known.add(form): Unit
        case Left(why)   =>
          refusals += 1
          last = Some(why)
          refused.put(of, why): Unit
      made
    }))

  private def refusedUnseen: Option[Either[Untraceable, Form]] =
    last.filter(_ => refusals >= mostRefused && known.isEmpty).map(Left(_))

  private def find(of: Of): Option[Either[Untraceable, Form]] =
    var i = 0
    while i < known.size do
      val form = known.get(i)
      if fits(form, of) then return Some(Right(form))
      i += 1
    Option(refused.get(of)).map(Left(_))

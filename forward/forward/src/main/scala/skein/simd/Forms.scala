package skein.simd

import java.util.{Collections, WeakHashMap}
import java.util.concurrent.CopyOnWriteArrayList
import skein.formula.Untraceable

/** A cache of the compiled forms of one kind of object, shared by all threads. As [[Recent]], it forgets
  * forms that are used least recently: a session may read ever new scenarios.
  *
  * @param fits whether an object has a form
  * @param mostRefused number of refusals after which, without any success, further objects are refused
  *   without an attempt, because compiling takes milliseconds
  * @param most see [[Recent]]
  * @param compile compiles an object's form, or states why it has none
  */
private[skein] final class Forms[Of, Form](
    fits: (Form, Of) => Boolean,
    mostRefused: Int = Int.MaxValue,
    most: Int = Forms.Most
)(
    compile: Of => Either[Untraceable, Form]
):
  require(most > 0, s"expected at least one form to keep, got $most")
  @volatile private var now, before = CopyOnWriteArrayList[Form]()

  /** Objects that were refused. Others of their class may still be formulas. */
  private val refused  = Collections.synchronizedMap(WeakHashMap[Of, Untraceable]())
  private var refusals = 0
  private var last     = Option.empty[Untraceable]

  def apply(of: Of): Either[Untraceable, Form] =
    find(of).getOrElse(synchronized(find(of).orElse(findBefore(of)).orElse(refusedUnseen).getOrElse {
      val made =
        try compile(of)
        catch case why: Untraceable => Left(why)
      made match
        case Right(form) => keep(form)
        case Left(why)   =>
          refusals += 1
          last = Some(why)
          refused.put(of, why): Unit
      made
    }))

  private def keep(form: Form): Unit =
    if now.size >= most then
      before = now
      now = CopyOnWriteArrayList()
    now.add(form): Unit

  private def refusedUnseen: Option[Either[Untraceable, Form]] =
    last.filter(_ => refusals >= mostRefused && now.isEmpty).map(Left(_))

  private def find(of: Of): Option[Either[Untraceable, Form]] =
    fitting(now, of).orElse(Option(refused.get(of)).map(Left(_)))

  private def findBefore(of: Of): Option[Either[Untraceable, Form]] =
    val found = fitting(before, of)
    found.foreach(_.foreach(keep))
    found

  private def fitting(
      among: CopyOnWriteArrayList[Form],
      of: Of
  ): Option[Either[Untraceable, Form]] =
    var i = 0
    while i < among.size do
      val form = among.get(i)
      if fits(form, of) then return Some(Right(form))
      i += 1
    None

private[skein] object Forms:
  /** Forms are found by trying one after another, and a search uses a few. */
  private val Most = 64

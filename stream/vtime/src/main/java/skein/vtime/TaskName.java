package skein.vtime;

import org.apache.pekko.dispatch.Mailbox;
import org.apache.pekko.dispatch.TaskInvocation;

/** Names tasks and actors for reports. In Java, because Scala cannot access Pekko's mailboxes. */
final class TaskName {
  private TaskName() {}

  /** The actor's path if the task is an actor's mailbox, else the task's class. */
  static String of(Runnable task) {
    return switch (task) {
      case Mailbox mailbox when mailbox.actor() != null -> mailbox.actor().self().path().toString();
      case TaskInvocation invocation -> of(invocation.runnable());
      default -> task.getClass().getName();
    };
  }
}

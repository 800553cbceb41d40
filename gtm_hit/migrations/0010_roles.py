from typing import Any

import django.db.models.deletion
from django.conf import settings
from django.db import migrations, models

ROLES = ("annotator", "reviewer", "manager", "maintainer", "administrator")


def make_groups(apps: Any, _schema: Any) -> None:
    """Staff could do everything: whoever is staff now becomes an administrator; superusers are anyway.

    A group that happens to have a role's name keeps its members under another one: they get no role by chance.
    """
    Group, User = (apps.get_model("auth", name) for name in ("Group", "User"))
    for group in Group.objects.filter(name__in=ROLES):
        group.name = f"{group.name} (before roles, {group.pk})"
        group.save(update_fields=["name"])
    groups = {role: Group.objects.create(name=role) for role in ROLES}
    RoleChange = apps.get_model("gtm_hit", "RoleChange")
    for user in User.objects.filter(is_staff=True, is_superuser=False):
        user.groups.add(groups["administrator"])
        RoleChange.objects.create(username=user.username, role="administrator", granted=True)


class Migration(migrations.Migration):

    dependencies = [
        ('auth', '0012_alter_user_first_name_max_length'),
        ("gtm_hit", "0009_campaigns"),
        migrations.swappable_dependency(settings.AUTH_USER_MODEL),
    ]

    operations = [
        migrations.CreateModel(
            name='RoleChange',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('at', models.DateTimeField(auto_now_add=True)),
                ('by', models.CharField(blank=True, help_text='empty: whoever runs the server', max_length=150)),
                ('username', models.CharField(max_length=150)),
                ('role', models.CharField(choices=[('annotator', 'annotator'), ('reviewer', 'reviewer'), ('manager', 'manager'), ('maintainer', 'maintainer'), ('administrator', 'administrator')], max_length=16)),
                ('dataset', models.CharField(blank=True, help_text='its name in addresses; empty: all', max_length=80)),
                ('granted', models.BooleanField(help_text='false: taken')),
            ],
            options={
                'ordering': ['-at', '-pk'],
                'indexes': [models.Index(fields=['dataset', 'at'], name='role_changes_of_a_dataset')],
            },
        ),
        migrations.CreateModel(
            name='Membership',
            fields=[
                ('id', models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name='ID')),
                ('role', models.CharField(choices=[('annotator', 'annotator'), ('reviewer', 'reviewer'), ('manager', 'manager'), ('maintainer', 'maintainer'), ('administrator', 'administrator')], max_length=16)),
                ('dataset', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='memberships', to='gtm_hit.dataset')),
                ('user', models.ForeignKey(on_delete=django.db.models.deletion.CASCADE, related_name='memberships', to=settings.AUTH_USER_MODEL)),
            ],
            options={
                'ordering': ['dataset', 'user__username', 'role'],
                'constraints': [models.UniqueConstraint(fields=('user', 'role', 'dataset'), name='membership_once')],
            },
        ),
        migrations.RunPython(make_groups, migrations.RunPython.noop),
    ]


from django.db import migrations, models


class Migration(migrations.Migration):

    dependencies = [
        ('gtm_hit', '0003_sensible_scene'),
    ]

    operations = [
        migrations.AddField(
            model_name='layer',
            name='unfinished',
            field=models.BooleanField(default=False, editable=False, help_text='an import is filling it; nobody sees it yet'),
        ),
    ]
